#include "config_table.h"

#include "slots/places.h"

/* clang-format would give each number a line of its own; a macro's arguments it lets stand. */
#define AT(member)   offsetof(struct config, member)
#define ROOM(member) sizeof(((struct config *)0)->member)
#define OPTION(kind, member, low, high, words, name, values, initial, help)                        \
    {                                                                                              \
        {name, values, initial, help}, kind, AT(member), low, high, words                          \
    }

#define KEY(index, name)                                                                           \
    OPTION(CONFIG_TEXT, key[index], 0, CONFIG_NAME, "none", "key." name, "LINE | none", "none",    \
           "Line of this bezel key, by name or as CHIP:OFFSET.")
#define FURTHER(index, name)                                                                       \
    OPTION(CONFIG_PATH_TO, further[index], 0, ROOM(further[index]), "none", name, "PATH | none",   \
           "none",                                                                                 \
           "A further image, a file, flown as long as it is there. The finest image that has "     \
           "data at a place answers.")
#define BUTTON_VALUES "none | designate | drop | 1..20 | gain+ | gain- | sym+ | ... | con-"
#define STICK(number, initial)                                                                     \
    OPTION(CONFIG_BUTTON, stick_map.button[(number)-1], 0, 0, NULL, "stick.button." #number,       \
           BUTTON_VALUES, initial, "What this button of the hand controller does.")
#define AXIS_VALUES "none | [-] x y z rx ry rz slider dial wheel hatx haty rudder throttle"

const struct config_row config_table[] = {
    OPTION(
        CONFIG_PATH_TO, slot_a, 0, ROOM(slot_a), "none", "slot.a", "PATH | none", SLOT_A,
        "First slot for a database: a file, a block device or an MTD device, which landmass-load "
        "writes. Of two slots the one of the later load that is whole is flown."),
    OPTION(CONFIG_PATH_TO, slot_b, 0, ROOM(slot_b), "none", "slot.b", "PATH | none", SLOT_B,
           "Second slot."),
    OPTION(CONFIG_PATH_TO, slot_progress, 0, ROOM(slot_progress), "none", "slot.progress",
           "PATH | none", SLOT_PROGRESS,
           "Where landmass-load says how far it is, for the BIT page. A file in memory."),
    OPTION(CONFIG_PATH_TO, database, 0, ROOM(database), NULL, "database", "PATH",
           "/var/lib/landmass-panel/database.lmdb",
           "Where no slot is whole: the database in flash, a file, or an MTD device such as "
           "/dev/mtd0."),
    FURTHER(0, "database.2"),
    FURTHER(1, "database.3"),
    FURTHER(2, "database.4"),
    OPTION(CONFIG_PATH_TO, database_key, 0, ROOM(database_key), "none", "database.key",
           "PATH | none", "none",
           "Public keys of those who may sign the database, up to eight in a PEM file."),
    OPTION(
        CONFIG_CHOICE, database_trust, 0, 0, "signed any", "database.trust", "signed | any",
        "signed",
        "Which database is flown: one that is signed by a key of database.key, or any, over which "
        "the glass then says UNSIGNED. One whose signature does not fit is never flown."),
    OPTION(CONFIG_CHOICE, database_older, 0, 0, "refuse fly", "database.older", "refuse | fly",
           "refuse",
           "What is done with a signed database whose serial number is below one that was flown."),
    OPTION(CONFIG_PATH_TO, database_serial, 0, ROOM(database_serial), "none", "database.serial",
           "PATH | none", "/var/lib/landmass-panel/serial",
           "File that remembers the highest serial number flown. none: it is not remembered."),
    OPTION(
        CONFIG_PATH_TO, radar, 0, ROOM(radar), "none", "radar", "PATH | none", "none",
        "Table of the radar, a record that landmass-radar wrote. none: the database's, or the "
        "one that is built in. A record that cannot be used leaves the glass without a picture."),
    OPTION(CONFIG_TEXT, can, 0, 16, "none", "can", "INTERFACE | none", "can0",
           "SocketCAN interface of the avionics bus."),
    OPTION(CONFIG_PROFILE, can_profile, 0, 0, NULL, "can.profile", "PROFILE | auto", "auto",
           "What the bus's frames mean: CANaerospace 1.7 (canas17), XCSoar's dialect (xcsoar), the "
           "table that was built in (generic), or another profile of docs/bus.md. auto: can.table, "
           "the database's table, or canas17 where there is neither."),
    OPTION(CONFIG_PATH_TO, can_table, 0, ROOM(can_table), "none", "can.table", "PATH | none",
           "none",
           "Table of the bus, a text (docs/bus.md). Beside a can.profile that is named, both are "
           "heard. With a table that cannot be read, or that clashes, the bus is not heard."),
    OPTION(CONFIG_TEXT, can_2, 0, 16, "none", "can2", "INTERFACE | none", "none",
           "A second interface, which is only heard."),
    OPTION(CONFIG_PROFILE, can_2_profile, 0, 0, NULL, "can2.profile", "PROFILE | auto", "auto",
           "What its frames mean. auto: can2.table, or canas17 where there is none."),
    OPTION(CONFIG_PATH_TO, can_2_table, 0, ROOM(can_2_table), "none", "can2.table", "PATH | none",
           "none", "Table of the second bus; as can.table."),
    OPTION(CONFIG_NODES, can_nodes, 0, 0, NULL, "can.nodes", "N,N,... | all", "all",
           "Nodes of the bus that are heard, 1..255 each; in NMEA 2000 the addresses of sources. "
           "Frames of others are refused and counted."),
    OPTION(
        CONFIG_NUMBER, can_node, 0, 255, NULL, "can.node", "0..255", "0",
        "The panel's node on a CANaerospace bus, where it answers requests; 0: it only listens."),
    OPTION(CONFIG_NUMBER, can_partner, 0, 255, NULL, "can.partner", "0..255", "0",
           "The node of the other display, which SWAP exchanges the page with (docs/bus.md, \"Two "
           "displays\"); 0: there is none. It needs can.node."),
    OPTION(CONFIG_CHOICE, can_heading, 0, 0, "true magnetic", "can.heading", "true | magnetic",
           "true",
           "What CANaerospace's heading angle (321) is from. A magnetic one needs the variation "
           "(1121) "
           "on the bus; without it the glass says MAG HDG."),
    OPTION(CONFIG_CHOICE, can_reports, 0, 0, "off on", "can.reports", "off | on", "off",
           "Whether that node tells cursor, designated place, mode, state and controls "
           "(docs/bus.md)."),
    OPTION(CONFIG_CHOICE, can_controls, 0, 0, "off obey", "can.controls", "off | obey", "off",
           "Whether keys, knobs and commands that come as frames of the bus are obeyed "
           "(docs/bus.md)."),
    OPTION(CONFIG_PATH_TO, settings, 0, ROOM(settings), "none", "settings", "PATH | none", "none",
           "The settings outlive a restart in this file, such as "
           "/var/lib/landmass-panel/settings; the glass then says RESTART for ten seconds."),
    OPTION(CONFIG_PATH_TO, faults, 0, ROOM(faults), "none", "faults", "PATH | none",
           "/var/lib/landmass-panel/faults",
           "The last 32 faults, a line each, in a file that outlives a power cut."),
    OPTION(CONFIG_NUMBER, seed, 0, 2147483647, NULL, "seed", "0..2147483647", "0",
           "Another number gives another speckle, and nothing else."),
    OPTION(CONFIG_NUMBER, tiles, 120, 512, NULL, "tiles", "120..512", "384",
           "Map tiles held in memory, 16.6 KiB each."),
    OPTION(CONFIG_CHOICE, glass, 0, 0, "auto drm fbdev none", "glass", "auto | drm | fbdev | none",
           "auto",
           "How the glass is driven. auto: DRM, or the frame buffer where there is no DRM."),
    OPTION(CONFIG_PATH_TO, glass_card, 0, ROOM(glass_card), NULL, "glass.card", "PATH",
           "/dev/dri/card0", "The DRM device."),
    OPTION(CONFIG_PATH_TO, glass_framebuffer, 0, ROOM(glass_framebuffer), NULL, "glass.framebuffer",
           "PATH", "/dev/fb0", "The frame buffer device."),
    OPTION(
        CONFIG_TEXT, glass_connector, 0, 32, "auto", "glass.connector", "NAME | auto", "auto",
        "DRM connector as under /sys/class/drm, such as HDMI-A-1. auto: the first with a screen."),
    OPTION(CONFIG_SIZE, glass_mode, 64, 8192, "auto", "glass.mode", "WIDTHxHEIGHT | auto", "auto",
           "Mode of the screen, 64..8192 pixels each way. auto: the one that the screen prefers."),
    OPTION(CONFIG_SIZE, glass_picture, 256, 1024, "auto", "glass.picture", "WIDTHxHEIGHT | auto",
           "auto",
           "The firmware's picture, 256..1024 pixels each way, centred on the screen. auto: the "
           "largest square that fits, or 768x768 when no screen is there at the start."),
    OPTION(CONFIG_CHOICE, glass_turn, 0, 0, "0 90 180 270", "glass.turn", "0 | 90 | 180 | 270", "0",
           "Degrees that the picture is turned clockwise on the screen."),
    OPTION(CONFIG_CHOICE, glass_format, 0, 0, "xrgb8888 rgb565", "glass.format",
           "xrgb8888 | rgb565", "xrgb8888",
           "Pixels of a DRM screen; a frame buffer tells its own."),
    OPTION(
        CONFIG_CHOICE, glass_sector, 0, 0, "full whole", "glass.sector", "full | whole", "full",
        "full: the sector is as high as its frame, which cuts its wings; whole: all of it fits."),
    OPTION(CONFIG_CHOICE, glass_heading, 0, 0, "off on", "glass.heading", "off | on", "off",
           "Whether the heading is written above the picture."),
    OPTION(CONFIG_CHOICE, glass_strobe, 0, 0, "off on", "glass.strobe", "off | on", "off",
           "Whether a faint line lies along the beam."),
    OPTION(CONFIG_CHOICE, glass_borders, 0, 0, "off on", "glass.borders", "off | on", "off",
           "Whether lines lie along the sector's edges."),
    KEY(0, "1"),
    KEY(1, "2"),
    KEY(2, "3"),
    KEY(3, "4"),
    KEY(4, "5"),
    KEY(5, "6"),
    KEY(6, "7"),
    KEY(7, "8"),
    KEY(8, "9"),
    KEY(9, "10"),
    KEY(10, "11"),
    KEY(11, "12"),
    KEY(12, "13"),
    KEY(13, "14"),
    KEY(14, "15"),
    KEY(15, "16"),
    KEY(16, "17"),
    KEY(17, "18"),
    KEY(18, "19"),
    KEY(19, "20"),
    KEY(20, "gain+"),
    KEY(21, "gain-"),
    KEY(22, "sym+"),
    KEY(23, "sym-"),
    KEY(24, "brt+"),
    KEY(25, "brt-"),
    KEY(26, "con+"),
    KEY(27, "con-"),
    KEY(CONFIG_KEY_DESIGNATE, "designate"),
    KEY(CONFIG_KEY_DROP, "drop"),
    OPTION(CONFIG_CHOICE, key_active_low, 0, 0, "high low", "keys.active", "high | low", "low",
           "Level of a key's line while it is pressed."),
    OPTION(CONFIG_NUMBER, debounce_ms, 1, 50, NULL, "keys.debounce", "1..50", "10",
           "Milliseconds that a line must be still before a key is believed."),
    OPTION(CONFIG_TEXT, led[CONFIG_LED_ALIVE], 0, CONFIG_NAME, "none", "led.alive", "LINE | none",
           "none", "Blinks once a second while pictures go to the glass."),
    OPTION(CONFIG_TEXT, led[CONFIG_LED_FAULT], 0, CONFIG_NAME, "none", "led.fault", "LINE | none",
           "none",
           "Lit while the glass shows a fault, a key is stuck, or the glass itself is lost."),
    OPTION(CONFIG_TEXT, led[CONFIG_LED_NIGHT], 0, CONFIG_NAME, "none", "led.night", "LINE | none",
           "none", "Lit while the night palette is chosen: key lights."),
    OPTION(CONFIG_CHOICE, led_active_low, 0, 0, "high low", "leds.active", "high | low", "high",
           "Level of an output's line while it is lit."),
    OPTION(CONFIG_TEXT, backlight, 0, CONFIG_NAME, "none", "backlight", "NAME | none", "none",
           "Backlight of the glass, as under /sys/class/backlight."),
    OPTION(CONFIG_NUMBER, backlight_day, 1, 100, NULL, "backlight.day", "1..100", "100",
           "Its brightness with the day palette, per cent."),
    OPTION(CONFIG_NUMBER, backlight_night, 1, 100, NULL, "backlight.night", "1..100", "20",
           "Its brightness with the night palette, per cent."),
    OPTION(CONFIG_DEVICE, stick, 0, 0, NULL, "stick", "VENDOR:PRODUCT[:SERIAL] | auto | none",
           "auto",
           "USB hand controller, in hexadecimal as lsusb prints it. auto: the first joystick, game "
           "pad or multi-axis controller."),
    OPTION(CONFIG_AXIS, stick_map.right, 0, 0, NULL, "stick.right", AXIS_VALUES, "x",
           "Axis that moves the cursor to the right; - turns it round."),
    OPTION(CONFIG_AXIS, stick_map.up, 0, 0, NULL, "stick.up", AXIS_VALUES, "-y",
           "Axis that moves the cursor up."),
    OPTION(CONFIG_AXIS, stick_map.knob, 0, 0, NULL, "stick.knob", AXIS_VALUES, "none",
           "Axis that is the range knob (fine gain)."),
    OPTION(CONFIG_NUMBER, stick_map.dead_percent, 0, 50, NULL, "stick.dead", "0..50", "5",
           "Dead zone around the middle, per cent of full deflection."),
    STICK(1, "designate"),
    STICK(2, "drop"),
    STICK(3, "none"),
    STICK(4, "none"),
    STICK(5, "none"),
    STICK(6, "none"),
    STICK(7, "none"),
    STICK(8, "none"),
    STICK(9, "none"),
    STICK(10, "none"),
    STICK(11, "none"),
    STICK(12, "none"),
    STICK(13, "none"),
    STICK(14, "none"),
    STICK(15, "none"),
    STICK(16, "none"),
    STICK(17, "none"),
    STICK(18, "none"),
    STICK(19, "none"),
    STICK(20, "none"),
    STICK(21, "none"),
    STICK(22, "none"),
    STICK(23, "none"),
    STICK(24, "none"),
    STICK(25, "none"),
    STICK(26, "none"),
    STICK(27, "none"),
    STICK(28, "none"),
    STICK(29, "none"),
    STICK(30, "none"),
    STICK(31, "none"),
    STICK(32, "none"),
    OPTION(
        CONFIG_PATH_TO, record, 0, ROOM(record), "none", "record", "PATH | none",
        "/var/lib/landmass-panel/recordings",
        "Folder of the recording of the last hours, which landmass-sim --replay shows again. It is "
        "made if the folder above it is there."),
    OPTION(
        CONFIG_NUMBER, record_size_mib, 64, 16000, NULL, "record.size", "64..16000", "4096",
        "MiB that recordings may take; the oldest go first. 70 to 140 MiB hold an hour of a busy "
        "bus. 64 MiB of the file system stay free in any case."),
    OPTION(CONFIG_NUMBER, priority, 0, 90, NULL, "realtime.priority", "0..90", "40",
           "SCHED_FIFO priority of the loop; 0: an ordinary process."),
    OPTION(CONFIG_CHOICE, locks_memory, 0, 0, "free locked", "realtime.memory", "free | locked",
           "locked", "Whether the program's memory may be paged out."),
    OPTION(CONFIG_PATH_TO, watchdog, 0, ROOM(watchdog), "none", "watchdog", "PATH | none", "none",
           "The board's watchdog, /dev/watchdog; leave it to systemd where systemd feeds it."),
    OPTION(CONFIG_NUMBER, watchdog_s, 1, 60, NULL, "watchdog.timeout", "1..60", "5",
           "Seconds after which the board is reset."),
};

_Static_assert(sizeof config_table / sizeof config_table[0] == CONFIG_ROWS,
               "the header says how many");
_Static_assert(CONFIG_KEYS == 30, "the table names every key");
