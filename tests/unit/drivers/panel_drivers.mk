# The panel's drivers: what is pure by itself, and the rest with the kernel or the library replaced by a fake that is as
# rude as the real one may be.
PANEL_TESTS := $(addprefix $(O)/bin/tests/unit/drivers/test_,hid stick debounce blit watchdog)
TESTS += $(PANEL_TESTS)
$(PANEL_TESTS): $(O)/bin/tests/unit/drivers/test_%: $(O)/tests/unit/drivers/test_%.o
$(PANEL_TESTS): LDLIBS := -lcmocka -pthread
$(O)/bin/tests/unit/drivers/test_hid: $(O)/drivers/usb/hid.o
$(O)/bin/tests/unit/drivers/test_stick: $(addprefix $(O)/drivers/usb/,stick.o hid.o)
$(O)/bin/tests/unit/drivers/test_debounce: $(O)/drivers/gpio/debounce.o
$(O)/bin/tests/unit/drivers/test_watchdog: $(addprefix $(O)/drivers/watchdog/,watchdog.o liveness.o)
$(O)/bin/tests/unit/drivers/test_blit: $(O)/drivers/display/blit.o

# These replace system calls: the linker leads the calls of the driver to the fake.
WRAP = $(foreach name,$(1),-Wl,--wrap=$(name))
$(O)/tests/unit/drivers/fake_drm.o: EXTRA_CFLAGS := $(call pkgs,cflags,libdrm)
T := $(O)/bin/tests/unit/drivers/test_drm
TESTS += $(T)
$(T): $(addprefix $(O)/,tests/unit/drivers/test_drm.o tests/unit/drivers/fake_drm.o $(addprefix drivers/display/,drm.o drm_screen.o blit.o))
$(T): LDLIBS := -lcmocka $(call WRAP,open close ioctl read mmap munmap)
T := $(O)/bin/tests/unit/drivers/test_flash_mtd
TESTS += $(T)
$(T): $(addprefix $(O)/,tests/unit/drivers/test_flash_mtd.o drivers/flash/flash_mtd.o drivers/flash/flash_reader.o)
$(T): LDLIBS := -lcmocka -pthread $(call WRAP,open close ioctl pread)

# The bezel over both versions of libgpiod, each a fake: version 1 where its header is installed, version 2 with a header of
# ours where it is not.
GPIO_TESTS := $(addprefix $(O)/bin/tests/unit/drivers/test_gpio,$(filter 1,$(GPIOD_MAJOR)) 2)
TESTS += $(GPIO_TESTS)
GPIOD2_HEADER := $(if $(filter 2,$(GPIOD_MAJOR)),,-Itests/unit/drivers/gpiod2)
$(O)/tests/unit/drivers/fake_gpiod2.o: EXTRA_CFLAGS := $(GPIOD2_HEADER)
$(O)/drivers/gpio/lines_gpiod2.o: CFLAGS_drivers += $(GPIOD2_HEADER)
$(GPIO_TESTS): $(O)/bin/tests/unit/drivers/test_gpio%: $(addprefix $(O)/tests/unit/drivers/,test_gpio.o fake_gpio.o fake_gpiod%.o) \
    $(addprefix $(O)/drivers/gpio/,gpio.o lines_gpiod%.o)
$(GPIO_TESTS): LDLIBS := -lcmocka
$(O)/bin/tests/unit/drivers/test_gpio2: LDLIBS += $(call WRAP,opendir readdir closedir)

# libusb is replaced whole, and so is the clock, which runs faster.
T := $(O)/bin/tests/unit/drivers/test_usb
TESTS += $(T)
$(O)/tests/unit/drivers/fake_usb.o: EXTRA_CFLAGS := $(call pkgs,cflags,libusb-1.0)
$(T): $(addprefix $(O)/,tests/unit/drivers/test_usb.o tests/unit/drivers/fake_usb.o drivers/usb/usb.o)
$(T): LDLIBS := -lcmocka -pthread $(call WRAP,clock_gettime)

T := $(O)/bin/tests/unit/drivers/test_fbdev
TESTS += $(T)
$(T): $(addprefix $(O)/,tests/unit/drivers/test_fbdev.o drivers/display/fbdev.o drivers/display/blit.o)
$(T): LDLIBS := -lcmocka $(call WRAP,open ioctl)
