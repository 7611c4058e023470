/* A second core, from PSCI's CPU_ON to C: as start.S does for the first, with its tables.
 * x0: struct core1 (peer.c): table, stack, function, argument. */
        .section .text.core1, "ax"
        .global core1_start
core1_start:
        msr     daifset, #15
        ldr     x1, =0x30d00800
        msr     sctlr_el1, x1
        ldr     x1, =zcu102_vectors
        msr     vbar_el1, x1
        mov     x1, #(3 << 20)
        msr     cpacr_el1, x1
        msr     tpidr_el1, xzr
        isb
        msr     spsel, #0
        mov     x19, x0
        ldr     x1, [x19, #8]
        mov     sp, x1
        ldr     x0, [x19]
        bl      zcu102_mmu_enable
        ldr     x0, [x19, #24]
        ldr     x1, [x19, #16]
        blr     x1
1:      wfi
        b       1b
