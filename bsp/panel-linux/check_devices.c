#include "check_devices.h"

#include "drv/gpio.h"
#include "report.h"

#include <dirent.h>
#include <drm.h>
#include <drm_mode.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "check_bus.h"

enum { ROOM_MIB = 80 }; /* what a recording needs, as docs/panel.md says */

/* The first word of a small file of the kernel's; empty if it cannot be read. */
static void read_word(const char *path, char *word, size_t size)
{
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    const ssize_t got = fd >= 0 ? read(fd, word, size - 1) : -1;
    if (fd >= 0) {
        close(fd);
    }
    word[got > 0 ? got : 0] = '\0';
    word[strcspn(word, " \n")] = '\0';
}

/* ---- screen ---- */

/* A connector of this card whose screen is there: "card0-HDMI-A-1". */
static bool find_screen(const char *card, const char *wanted, char *name, size_t size)
{
    DIR *folder = opendir("/sys/class/drm");
    bool is_found = false;
    for (struct dirent *e; !is_found && folder != NULL && (e = readdir(folder)) != NULL;) {
        char path[320], word[16];
        const size_t length = strlen(card);
        if (strncmp(e->d_name, card, length) != 0 || e->d_name[length] != '-' ||
            (wanted[0] != '\0' && strcmp(e->d_name + length + 1, wanted) != 0)) {
            continue;
        }
        snprintf(path, sizeof path, "/sys/class/drm/%s/status", e->d_name);
        read_word(path, word, sizeof word);
        is_found = strcmp(word, "connected") == 0;
        snprintf(name, size, "%s", e->d_name + length + 1);
    }
    if (folder != NULL) {
        closedir(folder);
    }
    return is_found;
}

/* Who opens a card first may set its mode. Nothing is set here, and it is closed at once. */
static bool check_card(const struct config *c)
{
    const char *slash = strrchr(c->glass_card, '/');
    char name[64] = "";
    const int fd = open(c->glass_card, O_RDWR | O_CLOEXEC);
    if (fd < 0) {
        report(REPORT_ERROR, "glass: %s: %s; %s", c->glass_card, strerror(errno),
               errno == EACCES ? "the user must be in the group video"
                               : "ls /dev/dri, then glass.card, or glass = fbdev");
        return false;
    }
    struct drm_mode_card_res resources = {0};
    const bool has_modes = ioctl(fd, DRM_IOCTL_MODE_GETRESOURCES, &resources) == 0;
    const bool is_ours = ioctl(fd, DRM_IOCTL_SET_MASTER, 0) == 0;
    close(fd);
    if (!has_modes) {
        report(REPORT_ERROR, "glass: %s: has no screens: it renders only; glass.card",
               c->glass_card);
        return false;
    }
    if (!find_screen(slash != NULL ? slash + 1 : c->glass_card, c->glass_connector, name,
                     sizeof name)) {
        report(REPORT_ERROR, "glass: %s: no screen is connected%s%s; cable, or glass.connector",
               c->glass_card, c->glass_connector[0] != '\0' ? " to " : "", c->glass_connector);
        return false;
    }
    report(REPORT_INFO, "glass: %s: screen at %s%s", c->glass_card, name,
           is_ours ? "" : "; another program holds it, so showing was not tried");
    return true;
}

static bool check_glass(const struct config *c)
{
    const bool has_card = access(c->glass_card, F_OK) == 0;
    if (c->glass == CONFIG_GLASS_NONE) {
        return true;
    }
    if (c->glass == CONFIG_GLASS_FBDEV || (c->glass == CONFIG_GLASS_AUTO && !has_card)) {
        const bool is_there = access(c->glass_framebuffer, R_OK | W_OK) == 0;
        report(is_there ? REPORT_INFO : REPORT_ERROR, "glass: %s: %s", c->glass_framebuffer,
               is_there ? "frame buffer" : strerror(errno));
        return is_there;
    }
    return check_card(c);
}

/* ---- keys, lamps, backlight ---- */

/* One line, asked for and given back. */
static bool check_line(const char *what, const char *name, bool is_output, bool is_active_low)
{
    struct drv_gpio gpio;
    if (name[0] == '\0') {
        return true;
    }
    bool is_sound = drv_gpio_open(&gpio) == 0;
    errno = 0;
    if (is_sound) {
        is_sound = (is_output ? drv_gpio_add_output(&gpio, name, is_active_low)
                              : drv_gpio_add_input(&gpio, name, is_active_low)) >= 0;
    }
    if (!is_sound && strstr(gpio.error, strerror(EBUSY)) != NULL) {
        report(REPORT_INFO,
               "%s: %s; was not tried: a panel that runs holds it, or gpioinfo names "
               "who does",
               what, gpio.error);
        is_sound = true;
    } else if (!is_sound) {
        report(REPORT_ERROR, "%s: %s; gpioinfo lists the lines, ls -l /dev/gpiochip* the rights",
               what, gpio.error);
    }
    drv_gpio_close(&gpio);
    return is_sound;
}

static int check_lines(const struct config *c)
{
    int wrong = 0;
    for (uint32_t i = 0; i < CONFIG_KEYS; i++) {
        wrong += !check_line("key", c->key[i], false, c->key_active_low != 0);
    }
    for (uint32_t i = 0; i < CONFIG_LEDS; i++) {
        wrong += !check_line("lamp", c->led[i], true, c->led_active_low != 0);
    }
    return wrong;
}

static bool check_backlight(const struct config *c)
{
    char path[160];
    snprintf(path, sizeof path, "/sys/class/backlight/%s/brightness", c->backlight);
    if (c->backlight[0] == '\0' || access(path, W_OK) == 0) {
        return true;
    }
    report(REPORT_ERROR, "backlight: %s: %s; ls /sys/class/backlight", path, strerror(errno));
    return false;
}

/* ---- hand controller ---- */

/* Whether the USB device of this folder of the kernel's is the one that is named, and where its
 * file is. */
static bool is_named_device(const struct config_stick *s, const char *name, char *file, size_t size)
{
    static const char *const parts[] = {"idVendor", "idProduct", "busnum", "devnum"};
    unsigned long number[4];
    for (int i = 0; i < 4; i++) {
        char path[320], word[16];
        snprintf(path, sizeof path, "/sys/bus/usb/devices/%s/%s", name, parts[i]);
        read_word(path, word, sizeof word);
        number[i] = strtoul(word, NULL, i < 2 ? 16 : 10);
    }
    snprintf(file, size, "/dev/bus/usb/%03lu/%03lu", number[2], number[3]);
    return number[2] != 0 && number[0] == s->vendor && number[1] == s->product;
}

static bool check_stick(const struct config *c)
{
    char file[64];
    bool is_there = false;
    if (c->stick.choice != CONFIG_STICK_NAMED) {
        return true; /* any that is plugged in, now or later */
    }
    DIR *folder = opendir("/sys/bus/usb/devices");
    for (struct dirent *e; !is_there && folder != NULL && (e = readdir(folder)) != NULL;) {
        is_there = e->d_name[0] != '.' && is_named_device(&c->stick, e->d_name, file, sizeof file);
    }
    if (folder != NULL) {
        closedir(folder);
    }
    const bool is_ours = is_there && access(file, R_OK | W_OK) == 0;
    if (!is_there) {
        report(REPORT_ERROR, "hand controller: no USB device %04x:%04x; lsusb", c->stick.vendor,
               c->stick.product);
    } else if (!is_ours) {
        report(REPORT_ERROR,
               "hand controller: %s: %s; unplug it and plug it in again, so that the "
               "udev rule matches",
               file, strerror(errno));
    }
    return is_ours;
}

/* ---- what is written ---- */

/* A file is made beside those of the option, brought to the medium and removed. */
static bool check_folder(const char *option, const char *folder)
{
    char path[192];
    struct statvfs room;
    snprintf(path, sizeof path, "%s/.check-XXXXXX", folder);
    const int fd = mkstemp(path);
    const bool is_written = fd >= 0 && write(fd, "check\n", 6) == 6 && fdatasync(fd) == 0;
    const int cause = errno;
    if (fd >= 0) {
        close(fd);
        (void)unlink(path);
    }
    if (!is_written) {
        report(REPORT_ERROR, "%s: %s: %s; make it, and chown landmass-panel, or another folder",
               option, folder, strerror(cause));
        return false;
    }
    if (strcmp(option, "record") == 0 && statvfs(folder, &room) == 0 &&
        room.f_bavail * (room.f_frsize >> 10) >> 10 < ROOM_MIB) {
        report(REPORT_ERROR, "%s: %s: less than %d MiB are free; free storage", option, folder,
               ROOM_MIB);
        return false;
    }
    return true;
}

/* The folder that a file or folder lies in; "." where the path has none. */
static void parent_of(const char *path, char *folder, size_t size)
{
    const char *slash = strrchr(path, '/');
    snprintf(folder, size, "%.*s",
             slash == NULL   ? 1
             : slash == path ? 1
                             : (int)(slash - path),
             slash == NULL ? "." : path);
}

static int check_written(const struct config *c)
{
    char folder[CONFIG_PATH + 1];
    int wrong = 0;
    if (c->record[0] != '\0') {
        /* It is made if the folder above it is there. */
        snprintf(folder, sizeof folder, "%s", c->record);
        if (access(folder, F_OK) != 0) {
            parent_of(c->record, folder, sizeof folder);
        }
        wrong += !check_folder("record", folder);
    }
    if (c->settings[0] != '\0') {
        parent_of(c->settings, folder, sizeof folder);
        wrong += !check_folder("settings", folder);
    }
    if (c->faults[0] != '\0') {
        parent_of(c->faults, folder, sizeof folder);
        wrong += !check_folder("faults", folder);
    }
    if (c->database_serial[0] != '\0') {
        parent_of(c->database_serial, folder, sizeof folder);
        wrong += !check_folder("database.serial", folder);
    }
    return wrong;
}

static bool check_watchdog(const struct config *c)
{
    if (c->watchdog[0] == '\0' || access(c->watchdog, W_OK) == 0) {
        return true;
    }
    report(REPORT_ERROR, "watchdog: %s: %s; modprobe its driver, or watchdog = none", c->watchdog,
           strerror(errno));
    return false;
}

int check_devices(const struct config *config)
{
    int wrong = check_lines(config) + check_written(config);
    wrong += !check_glass(config);
    wrong += !check_backlight(config);
    wrong += !check_stick(config);
    wrong += !check_watchdog(config);
    wrong += !check_bus("can", config->can);
    wrong += !check_bus("can2", config->can_2);
    return wrong;
}
