#include "wire/panel.h"

#include <errno.h>
#include <openssl/evp.h>
#include <stdio.h>
#include <string.h>

enum {
    OTHERS_MAX = 64,        /* messages of another session that are passed over for one answer */
    GUESS_BYTES_MIN = 4096, /* a shorter piece is as quickly sent */
    TELL_MS = 5000          /* a PC that does not take what it is told is not waited for */
};

static int tell(struct wire_panel *p, uint32_t kind, const char *text, uint32_t timeout_ms)
{
    p->out.kind = kind;
    p->out.session = p->session;
    snprintf(p->out.text, sizeof p->out.text, "%s", text);
    const int cause = wire_send(p->link, &p->out, NULL, timeout_ms);
    p->out = (struct wire_message){0};
    return cause;
}

static int end(struct wire_panel *p, int cause)
{
    p->cause = p->cause != 0 ? p->cause : cause;
    return LM_ERR_IO;
}

/* The next message of this session. An offer of another one ends it: that PC has begun anew. */
static int next(struct wire_panel *p)
{
    for (uint32_t i = 0; i < OTHERS_MAX; i++) {
        const int cause = wire_receive(p->link, &p->in, p->payload, p->answer_ms);
        if (cause != 0) {
            p->bad += cause == EBADMSG || cause == EMSGSIZE || cause == EPROTONOSUPPORT;
            return cause;
        }
        if (p->in.kind == WIRE_OFFER) {
            p->has_offer = true;
            return ECONNRESET;
        }
        if (p->in.session == p->session) {
            return 0;
        }
    }
    return EPROTO;
}

static bool is_digest(const uint8_t digest[WIRE_DIGEST_BYTES])
{
    static const uint8_t none[WIRE_DIGEST_BYTES];
    return memcmp(digest, none, sizeof none) != 0;
}

/* What may be there already goes to the destination at once; the PC says whether it is that. */
static void guess(struct wire_panel *p, uint64_t offset, void *to, uint32_t length)
{
    if (p->guess && length >= GUESS_BYTES_MIN && p->guess(p->guess_ctx, offset, to, length) == 0 &&
        EVP_Digest(to, length, p->out.digest, NULL, EVP_sha256(), NULL) != 1) {
        memset(p->out.digest, 0, sizeof p->out.digest);
    }
}

static int fetch(struct wire_panel *p, uint64_t offset, void *to, uint32_t length)
{
    p->out.offset = offset;
    p->out.bytes = length;
    guess(p, offset, to, length);
    const bool may_be_same = is_digest(p->out.digest);
    int cause = tell(p, WIRE_ASK, "", p->answer_ms);
    cause = cause == 0 ? next(p) : cause;
    if (cause != 0) {
        return cause;
    }
    const struct wire_message *in = &p->in;
    if (in->kind == WIRE_FAILED) {
        snprintf(p->text, sizeof p->text, "%s", in->text);
        return ECANCELED;
    }
    const bool is_that = in->offset == offset && in->bytes == length;
    if (is_that && in->kind == WIRE_SAME && may_be_same && in->payload_bytes == 0) {
        p->same_bytes += length;
        return 0;
    }
    if (is_that && in->kind == WIRE_DATA && in->payload_bytes == length) {
        memcpy(to, p->payload, length);
        p->sent_bytes += length;
        return 0;
    }
    p->bad++;
    return EPROTO;
}

static int read_start(void *ctx, uint64_t offset, void *to, uint32_t length)
{
    struct wire_panel *p = ctx;
    if (offset > p->port.size_bytes || length > p->port.size_bytes - offset) {
        return LM_ERR_RANGE;
    }
    uint8_t *at = to;
    while (length > 0 && p->cause == 0) {
        const uint32_t piece = length < WIRE_PIECE_BYTES ? length : (uint32_t)WIRE_PIECE_BYTES;
        const int cause = fetch(p, offset, at, piece);
        if (cause != 0) {
            return end(p, cause);
        }
        offset += piece;
        at += piece;
        length -= piece;
    }
    return p->cause == 0 ? LM_OK : LM_ERR_IO;
}

static int read_poll(void *ctx)
{
    const struct wire_panel *p = ctx;
    return p->cause == 0 ? LM_OK : LM_ERR_IO;
}

void wire_panel_open(struct wire_panel *p, const struct wire_link *link, uint32_t answer_ms)
{
    memset(p, 0, sizeof *p);
    p->link = link;
    p->answer_ms = answer_ms;
    p->port = (struct lm_flash){.ctx = p, .read_start = read_start, .read_poll = read_poll};
}

static void begin(struct wire_panel *p)
{
    p->session = p->in.session;
    p->port.size_bytes = p->in.bytes;
    p->has_offer = false;
    p->guess = NULL;
    p->cause = 0;
    p->text[0] = '\0';
    p->percent = -1;
    p->sent_bytes = p->same_bytes = 0;
}

int wire_panel_wait(struct wire_panel *p)
{
    while (!p->has_offer) {
        const int cause = wire_receive(p->link, &p->in, p->payload, 0);
        if (cause == EPROTONOSUPPORT) {
            char text[WIRE_TEXT_BYTES];
            snprintf(text, sizeof text, "the panel has version %d of the protocol, the PC %u",
                     (int)WIRE_VERSION, (unsigned)p->in.version);
            p->session = p->in.session;
            wire_panel_refuse(p, text);
        }
        const bool is_bad = cause == EBADMSG || cause == EMSGSIZE || cause == EPROTONOSUPPORT;
        if (cause != 0 && !is_bad) {
            return cause;
        }
        p->bad += is_bad;
        p->has_offer = cause == 0 && p->in.kind == WIRE_OFFER;
    }
    begin(p);
    return 0;
}

void wire_panel_welcome(struct wire_panel *p, const char *slots)
{
    const int cause = tell(p, WIRE_WELCOME, slots, p->answer_ms);
    if (cause != 0) {
        (void)end(p, cause);
    }
}

void wire_panel_status(struct wire_panel *p, uint64_t done_bytes, uint64_t all_bytes)
{
    const uint64_t done = done_bytes < all_bytes ? done_bytes : all_bytes;
    const int32_t percent = (int32_t)(done / (all_bytes / 100 + 1));
    if (p->cause != 0 || percent == p->percent) {
        return;
    }
    p->percent = percent;
    p->out.offset = done_bytes;
    p->out.bytes = all_bytes;
    p->cause = tell(p, WIRE_STATUS, "", TELL_MS);
}

void wire_panel_done(struct wire_panel *p, const struct wire_figures *figures, const char *text)
{
    if (p->cause == 0) {
        p->out.figures = *figures;
        p->cause = tell(p, WIRE_DONE, text, TELL_MS);
    }
}

void wire_panel_refuse(struct wire_panel *p, const char *text)
{
    switch (p->cause) {
    case 0:
    case EBADMSG:
    case EMSGSIZE:
    case EPROTO:
    case EPROTONOSUPPORT:
    case ECANCELED: /* it still listens */
        (void)end(p, tell(p, WIRE_REFUSED, text, TELL_MS));
        break;
    default:
        break;
    }
}
