/* From reset to main: exception level 1, stacks, translation tables, caches, cleared variables.
 * Registers are those of the Arm Architecture Reference Manual for A-profile (DDI 0487), chapter D.
 *
 * Started at EL1 or EL2 by the boot firmware (FSBL and Trusted Firmware-A), which owns EL3 and
 * answers PSCI calls. At EL3 there is nobody to restart the board, so the core waits there. */

        .section .init, "ax"
        .global _start
_start:
        msr     daifset, #15
        mrs     x0, CurrentEL
        cmp     x0, #(2 << 2)
        b.eq    leave_el2
        cmp     x0, #(1 << 2)
        b.eq    at_el1
1:      wfi
        b       1b

leave_el2:
        mov     x0, #(1 << 31)          // HCR_EL2.RW: EL1 is 64-bit
        msr     hcr_el2, x0
        mov     x0, #3                  // CNTHCTL_EL2: EL1 may use the physical timer
        msr     cnthctl_el2, x0
        msr     cntvoff_el2, xzr
        mov     x0, #0x33ff             // CPTR_EL2: no trap of vector instructions
        msr     cptr_el2, x0
        mrs     x0, midr_el1
        msr     vpidr_el2, x0
        mrs     x0, mpidr_el1
        msr     vmpidr_el2, x0
        mov     x0, #0x3c4              // SPSR_EL2: EL1 with SP_EL0, everything masked
        msr     spsr_el2, x0
        adr     x0, at_el1
        msr     elr_el2, x0
        eret

at_el1:
        ldr     x0, =0x30d00800         // SCTLR_EL1: reserved ones, MMU and caches off
        msr     sctlr_el1, x0
        isb
        ldr     x0, =zcu102_vectors
        msr     vbar_el1, x0
        mov     x0, #(3 << 20)          // CPACR_EL1.FPEN: vector instructions
        msr     cpacr_el1, x0
        msr     tpidr_el1, xzr          // no interrupt controller yet (board.h)
        isb

        // Exceptions have a stack of their own, SP_EL1; everything else runs on SP_EL0.
        msr     spsel, #1
        ldr     x0, =__exception_stack_top
        mov     sp, x0
        msr     spsel, #0
        ldr     x0, =__stack_top
        mov     sp, x0

        ldr     x0, =__tables_start
        ldr     x1, =__tables_end
1:      stp     xzr, xzr, [x0], #16
        cmp     x0, x1
        b.lo    1b
        bl      zcu102_mmu_build
        bl      zcu102_mmu_enable

        ldr     x0, =__bss_start
        mov     x1, #0
        ldr     x2, =__bss_end
        sub     x2, x2, x0
        bl      memset

        // Painted, so that the deepest use can be read off later (stack.h).
        ldr     x0, =__stack_bottom
        ldr     x1, =__stack_top
        ldr     x2, =0x5ac1a57a5ac1a57a
1:      stp     x2, x2, [x0], #16
        cmp     x0, x1
        b.lo    1b

        bl      main
1:      wfi
        b       1b

/* void zcu102_mmu_enable(const void *table): x0, the level-1 table. Also what a second core calls. */
        .global zcu102_mmu_enable
zcu102_mmu_enable:
        ldr     x1, =0x0444ff           // MAIR: 0 write-back, 1 not cached, 2 device nGnRE
        msr     mair_el1, x1
        // TCR: 39-bit addresses, tables in write-back shareable memory, 4 KiB pages, no upper half,
        // 40-bit physical addresses.
        ldr     x1, =(25 | 1 << 8 | 1 << 10 | 3 << 12 | 1 << 23 | 2 << 32)
        msr     tcr_el1, x1
        msr     ttbr0_el1, x0
        dsb     sy
        tlbi    vmalle1
        ic      iallu
        dsb     sy
        isb
        mrs     x1, sctlr_el1
        ldr     x2, =(1 << 0 | 1 << 2 | 1 << 12 | 1 << 19)  // M, C, I, WXN: what can be written is never run
        orr     x1, x1, x2
        msr     sctlr_el1, x1
        isb
        ret
