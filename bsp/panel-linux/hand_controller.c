#include "hand_controller.h"

#include "report.h"

#include <string.h>

static bool wants(void *ctx, const struct drv_usb_identity *identity)
{
    const struct hand *h = ctx;
    const struct config_stick *s = &h->config->stick;
    if (s->choice == CONFIG_STICK_NAMED) {
        return identity->vendor == s->vendor && identity->product == s->product;
    }
    return !identity->is_boot_device; /* opening it would take a keyboard from the system */
}

static const char *attach(void *ctx, const struct drv_usb_identity *identity,
                          const uint8_t *descriptor, size_t size)
{
    struct hand *h = ctx;
    const struct config_stick *s = &h->config->stick;
    if (s->serial[0] != '\0' && strcmp(s->serial, identity->serial) != 0) {
        return "its serial number is another one";
    }
    return drv_stick_attach(&h->stick, descriptor, size, s->choice == CONFIG_STICK_NAMED);
}

static void take_report(void *ctx, const uint8_t *bytes, size_t size)
{
    struct hand *h = ctx;
    drv_stick_report(&h->stick, bytes, size);
}

static void detach(void *ctx)
{
    struct hand *h = ctx;
    drv_stick_detach(&h->stick);
}

static void idle(void *ctx)
{
    struct hand *h = ctx;
    drv_stick_tell(&h->stick, &h->ring);
}

static void tell(void *ctx, const char *text)
{
    (void)ctx;
    report(REPORT_NOTICE, "hand controller: %s", text);
}

void hand_open(struct hand *h, const struct config *config)
{
    const struct drv_usb_client client = {.ctx = h,
                                          .wants = wants,
                                          .attach = attach,
                                          .report = take_report,
                                          .detach = detach,
                                          .idle = idle,
                                          .tell = tell};
    char error[160];
    memset(h, 0, sizeof *h);
    h->config = config;
    drv_stick_init(&h->stick, &config->stick_map);
    if (config->stick.choice == CONFIG_STICK_NONE) {
        return;
    }
    h->usb = drv_usb_start(&client, 1, error);
    if (h->usb == NULL) {
        report(REPORT_ERROR, "hand controller: %s", error);
    }
}

void hand_close(struct hand *h)
{
    drv_usb_stop(h->usb);
    h->usb = NULL;
}
