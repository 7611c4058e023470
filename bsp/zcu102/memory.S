/* memcpy, memmove, memset, memcmp: what a compiler may call by itself (fx/mem.h). Normal memory
 * may be read and written unaligned once the MMU is on, which it is before main. */
        .section .text.memory, "ax"

/* void *memmove(void *to, const void *from, size_t length) */
        .global memmove
memmove:
        sub     x3, x0, x1
        cmp     x3, x2
        b.hs    memcpy                  // `to` is not within `from`: upwards is right
        add     x3, x0, x2
        add     x1, x1, x2
1:      subs    x2, x2, #16
        b.lo    2f
        ldp     x4, x5, [x1, #-16]!
        stp     x4, x5, [x3, #-16]!
        b       1b
2:      add     x2, x2, #16
3:      cbz     x2, 4f
        ldrb    w4, [x1, #-1]!
        strb    w4, [x3, #-1]!
        sub     x2, x2, #1
        b       3b
4:      ret

/* void *memcpy(void *to, const void *from, size_t length) */
        .global memcpy
memcpy:
        mov     x3, x0
        subs    x2, x2, #64
        b.lo    2f
1:      ldp     x4, x5, [x1]
        ldp     x6, x7, [x1, #16]
        ldp     x8, x9, [x1, #32]
        ldp     x10, x11, [x1, #48]
        stp     x4, x5, [x3]
        stp     x6, x7, [x3, #16]
        stp     x8, x9, [x3, #32]
        stp     x10, x11, [x3, #48]
        add     x1, x1, #64
        add     x3, x3, #64
        subs    x2, x2, #64
        b.hs    1b
2:      add     x2, x2, #64
        tbz     x2, #5, 3f
        ldp     x4, x5, [x1], #16
        ldp     x6, x7, [x1], #16
        stp     x4, x5, [x3], #16
        stp     x6, x7, [x3], #16
3:      tbz     x2, #4, 4f
        ldp     x4, x5, [x1], #16
        stp     x4, x5, [x3], #16
4:      tbz     x2, #3, 5f
        ldr     x4, [x1], #8
        str     x4, [x3], #8
5:      tbz     x2, #2, 6f
        ldr     w4, [x1], #4
        str     w4, [x3], #4
6:      tbz     x2, #1, 7f
        ldrh    w4, [x1], #2
        strh    w4, [x3], #2
7:      tbz     x2, #0, 8f
        ldrb    w4, [x1]
        strb    w4, [x3]
8:      ret

/* void *memset(void *to, int byte, size_t length) */
        .global memset
memset:
        mov     x3, x0
        and     x1, x1, #255
        orr     x1, x1, x1, lsl #8
        orr     x1, x1, x1, lsl #16
        orr     x1, x1, x1, lsl #32
        cbnz    x1, 9f
        cmp     x2, #320
        b.lo    9f

        // Many zeros: whole blocks of the cache at a time, 64 bytes each on this core. What lies
        // before the first block and behind the last is stored.
        add     x2, x2, x3              // the end
        stp     xzr, xzr, [x3]
        stp     xzr, xzr, [x3, #16]
        stp     xzr, xzr, [x3, #32]
        stp     xzr, xzr, [x3, #48]
        add     x3, x3, #64
        and     x3, x3, #~63
        sub     x2, x2, x3
        sub     x2, x2, #256
0:      .rept   4
        dc      zva, x3
        add     x3, x3, #64
        .endr
        subs    x2, x2, #256
        b.hs    0b
        add     x2, x2, #256

9:      subs    x2, x2, #64
        b.lo    2f
1:      stp     x1, x1, [x3]
        stp     x1, x1, [x3, #16]
        stp     x1, x1, [x3, #32]
        stp     x1, x1, [x3, #48]
        add     x3, x3, #64
        subs    x2, x2, #64
        b.hs    1b
2:      add     x2, x2, #64
        tbz     x2, #5, 3f
        stp     x1, x1, [x3], #16
        stp     x1, x1, [x3], #16
3:      tbz     x2, #4, 4f
        stp     x1, x1, [x3], #16
4:      tbz     x2, #3, 5f
        str     x1, [x3], #8
5:      tbz     x2, #2, 6f
        str     w1, [x3], #4
6:      tbz     x2, #1, 7f
        strh    w1, [x3], #2
7:      tbz     x2, #0, 8f
        strb    w1, [x3]
8:      ret

/* int memcmp(const void *a, const void *b, size_t length) */
        .global memcmp
memcmp:
        cbz     x2, 2f
1:      ldrb    w3, [x0], #1
        ldrb    w4, [x1], #1
        subs    w3, w3, w4
        b.ne    3f
        subs    x2, x2, #1
        b.ne    1b
2:      mov     w3, #0
3:      mov     w0, w3
        ret
