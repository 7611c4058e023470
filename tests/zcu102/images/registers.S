/* bool registers_survive(const volatile uint32_t *interrupts): fill what a function may use with
 * patterns, wait until *interrupts changes, and look whether they are still there. */
        .macro  fill register, number
        mov     x\register, #(0x1000 + 7 * \number)
        movk    x\register, #(0xa000 + \number), lsl #48
        .endm

        .macro  check register, number
        mov     x24, #(0x1000 + 7 * \number)
        movk    x24, #(0xa000 + \number), lsl #48
        eor     x24, x24, x\register
        orr     x23, x23, x24
        .endm

        .section .text.registers, "ax"
        .global registers_survive
registers_survive:
        stp     x29, x30, [sp, #-64]!
        stp     x19, x20, [sp, #16]
        stp     x21, x22, [sp, #32]
        stp     x23, x24, [sp, #48]
        mov     x19, x0
        ldr     w20, [x19]
        .irp    n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,29,30
        fill    \n, \n
        .endr
        .irp    n, 0,7,15,16
        dup     v\n\().2d, x\n
        .endr
        mov     x22, #0x60000000        // Z and C
        msr     nzcv, x22
1:      ldr     w21, [x19]
        sub     w21, w21, w20
        cbz     w21, 1b
        mrs     x23, nzcv
        eor     x23, x23, x22
        .irp    n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,29,30
        check   \n, \n
        .endr
        .irp    n, 0,7,15,16
        mov     x21, v\n\().d[1]
        check   21, \n
        .endr
        cmp     x23, #0
        cset    w0, eq
        ldp     x19, x20, [sp, #16]
        ldp     x21, x22, [sp, #32]
        ldp     x23, x24, [sp, #48]
        ldp     x29, x30, [sp], #64
        ret
