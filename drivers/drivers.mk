# The drivers of a Linux machine. libgpiod has two incompatible versions: the file for the one that is installed is taken.
# Of the kernel's display interface only the headers are taken from libdrm.
GPIOD_MAJOR   := $(or $(firstword $(subst ., ,$(call pkgs,modversion,libgpiod))),1)
LINUX_DRIVERS := can/can_socket $(addprefix display/,blit drm drm_screen fbdev) \
    $(addprefix flash/,flash_file flash_joined flash_mtd flash_reader) $(addprefix gpio/,debounce gpio lines_gpiod$(GPIOD_MAJOR)) \
    not_fitted/not_fitted $(addprefix usb/,hid stick usb) watchdog/watchdog
LINUX_LIBS    := $(call pkgs,libs,libusb-1.0 libgpiod) -pthread
$(O)/drivers/display/%.o: CFLAGS_drivers += $(call pkgs,cflags,libdrm)
$(O)/drivers/usb/%.o: CFLAGS_drivers += $(call pkgs,cflags,libusb-1.0)
