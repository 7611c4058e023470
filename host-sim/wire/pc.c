#include "wire/pc.h"

#include <errno.h>
#include <openssl/evp.h>
#include <stdio.h>
#include <string.h>

enum {
    OTHERS_MAX = 64,    /* messages of an earlier session that may still be on their way */
    SEND_MS = 60 * 1000 /* in which a panel takes a message */
};

static int say(struct wire_pc *pc, uint32_t kind, uint32_t payload_bytes)
{
    pc->out.kind = kind;
    pc->out.session = pc->session;
    pc->out.payload_bytes = payload_bytes;
    const int cause = wire_send(pc->link, &pc->out, pc->payload, SEND_MS);
    pc->out = (struct wire_message){0};
    return cause;
}

/* The next message of this session. */
static int next(struct wire_pc *pc)
{
    for (uint32_t i = 0; i < OTHERS_MAX; i++) {
        const int cause = wire_receive(pc->link, &pc->in, pc->payload, pc->wait_ms);
        pc->version = pc->in.version;
        if (cause != 0 || pc->in.session == pc->session) {
            return cause;
        }
    }
    return EPROTO;
}

static int fail(struct wire_pc *pc)
{
    snprintf(pc->out.text, sizeof pc->out.text, "the PC cannot read the image any more");
    (void)say(pc, WIRE_FAILED, 0);
    return EIO;
}

static void advance(struct wire_pc *pc, enum wire_stage stage, uint64_t done, uint64_t all)
{
    if (pc->progress) {
        pc->progress(pc->ctx, stage, done, all);
    }
}

static int answer(struct wire_pc *pc)
{
    const uint64_t offset = pc->in.offset, bytes = pc->in.bytes, all = pc->image.bytes;
    uint8_t digest[WIRE_DIGEST_BYTES];
    if (bytes == 0 || bytes > WIRE_PIECE_BYTES || offset > all || bytes > all - offset) {
        return EPROTO;
    }
    const uint32_t length = (uint32_t)bytes;
    if (pc->image.read(pc->image.ctx, offset, pc->payload, length) != 0 ||
        EVP_Digest(pc->payload, length, digest, NULL, EVP_sha256(), NULL) != 1) {
        return fail(pc);
    }
    const bool is_same = memcmp(digest, pc->in.digest, sizeof digest) == 0;
    pc->out.offset = offset;
    pc->out.bytes = bytes;
    *(is_same ? &pc->same_bytes : &pc->sent_bytes) += bytes;
    advance(pc, WIRE_SENDING, offset + bytes, all);
    return say(pc, is_same ? WIRE_SAME : WIRE_DATA, is_same ? 0 : length);
}

/* EAGAIN: there is more to come. */
static int take(struct wire_pc *pc)
{
    const struct wire_message *in = &pc->in;
    switch (in->kind) {
    case WIRE_WELCOME:
        if (pc->welcome) {
            pc->welcome(pc->ctx, in->text);
        }
        return EAGAIN;
    case WIRE_ASK: {
        const int cause = answer(pc);
        return cause == 0 ? EAGAIN : cause;
    }
    case WIRE_STATUS:
        advance(pc, WIRE_CHECKING, in->offset < in->bytes ? in->offset : in->bytes, in->bytes);
        return EAGAIN;
    case WIRE_DONE:
    case WIRE_REFUSED:
        pc->figures = in->figures;
        memcpy(pc->text, in->text, sizeof pc->text);
        return in->kind == WIRE_DONE ? 0 : ECANCELED;
    default:
        return EPROTO;
    }
}

int wire_pc_run(struct wire_pc *pc)
{
    pc->out = (struct wire_message){.bytes = pc->image.bytes};
    int cause = say(pc, WIRE_OFFER, 0);
    cause = cause == 0 ? EAGAIN : cause;
    while (cause == EAGAIN) {
        cause = next(pc);
        cause = cause == 0 ? take(pc) : cause;
    }
    return cause;
}
