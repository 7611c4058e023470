/* Link: a way for bytes between a maintenance PC and a panel, whole blocks at a time. USB carries
 * it (wire/usb.h), or a local socket (wire/socket.h); tests have their own.
 *
 * Each function returns 0 or an errno:
 * - ETIMEDOUT: the other side did not take or give the bytes in time,
 * - ENODEV: the cable was pulled, or nobody is there any more,
 * - EINTR: the program is to end (hs/real_time.h),
 * - another one: the device failed.
 * After an error the blocks of the other side may be anywhere; wire/message.h finds the next one.
 */
#ifndef WIRE_LINK_H
#define WIRE_LINK_H

#include <stdint.h>

/* Every length is a multiple of this one, which is one of every packet size of USB: so no transfer
 * ends with a short packet, and both sides know how long each is. */
enum { WIRE_BLOCK_BYTES = 1024 };

struct wire_link {
    void *ctx;

    /* All bytes or an error. `timeout_ms` 0: wait for ever. */
    int (*send)(void *ctx, const void *from, uint32_t length, uint32_t timeout_ms);
    int (*receive)(void *ctx, void *to, uint32_t length, uint32_t timeout_ms);
};

#endif
