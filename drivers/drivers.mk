# The drivers of a Linux machine. Of the kernel's display interface only the headers are taken from libdrm.
LINUX_DRIVERS := can/can_socket $(addprefix display/,blit drm drm_screen fbdev) $(addprefix flash/,flash_file flash_mtd flash_reader) \
    $(addprefix watchdog/,liveness watchdog)
LINUX_LIBS    := $(call pkgs,libs,libusb-1.0 libgpiod) -pthread
$(O)/drivers/display/%.o: CFLAGS_drivers += $(call pkgs,cflags,libdrm)
