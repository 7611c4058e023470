/* The sixteen exception vectors (DDI 0487, D1.10.2). An interrupt saves what it must and returns;
 * everything else is reported and ends in a restart (exception.c).
 *
 * Normal code runs on SP_EL0, exceptions on SP_EL1. An exception in an exception therefore comes
 * through the second group, and its stack may be what is broken: it starts on the last stack. */
#define FRAME_BYTES 272                 /* struct zcu102_frame: x0..x30, pc, pstate */

        .macro  vector kind, target
        .balign 128
        sub     sp, sp, #FRAME_BYTES
        stp     x0, x1, [sp]
        mov     x0, #\kind
        b       \target
        .endm

        .macro  nested_vector kind
        .balign 128
        msr     tpidr_el0, x0
        ldr     x0, =__last_stack_top
        mov     sp, x0
        mrs     x0, tpidr_el0
        sub     sp, sp, #FRAME_BYTES
        stp     x0, x1, [sp]
        mov     x0, #(\kind + 4)
        b       report
        .endm

        .macro  save
        stp     x2, x3, [sp, #16]
        stp     x4, x5, [sp, #32]
        stp     x6, x7, [sp, #48]
        stp     x8, x9, [sp, #64]
        stp     x10, x11, [sp, #80]
        stp     x12, x13, [sp, #96]
        stp     x14, x15, [sp, #112]
        stp     x16, x17, [sp, #128]
        stp     x18, x19, [sp, #144]
        stp     x20, x21, [sp, #160]
        stp     x22, x23, [sp, #176]
        stp     x24, x25, [sp, #192]
        stp     x26, x27, [sp, #208]
        stp     x28, x29, [sp, #224]
        mrs     x1, elr_el1
        stp     x30, x1, [sp, #240]
        mrs     x1, spsr_el1
        str     x1, [sp, #256]
        .endm

        .section .text.vectors, "ax"
        .balign 2048
        .global zcu102_vectors
zcu102_vectors:
        vector  0, report               // from normal code: synchronous
        vector  1, interrupt            // IRQ
        vector  2, report               // FIQ
        vector  3, report               // SError
        nested_vector 0                 // from an exception
        nested_vector 1
        nested_vector 2
        nested_vector 3
        .rept   8                       // from EL0, where nothing runs
        nested_vector 4
        .endr

report:
        save
        mov     x1, sp
        bl      zcu102_exception        // does not return
1:      b       1b

/* The compiler keeps handlers out of the vector registers (-mgeneral-regs-only), and saves x19..x28
 * itself; they are in the frame for the report only. */
interrupt:
        save
        mov     x0, sp
        bl      zcu102_interrupt
        ldr     x1, [sp, #256]
        msr     spsr_el1, x1
        ldp     x30, x1, [sp, #240]
        msr     elr_el1, x1
        ldp     x2, x3, [sp, #16]
        ldp     x4, x5, [sp, #32]
        ldp     x6, x7, [sp, #48]
        ldp     x8, x9, [sp, #64]
        ldp     x10, x11, [sp, #80]
        ldp     x12, x13, [sp, #96]
        ldp     x14, x15, [sp, #112]
        ldp     x16, x17, [sp, #128]
        ldr     x18, [sp, #144]
        ldr     x29, [sp, #232]
        ldp     x0, x1, [sp]
        add     sp, sp, #FRAME_BYTES
        eret
