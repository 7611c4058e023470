# panel-linux: an ARM64 or x86-64 Linux panel. ARCH is Debian's name of the machine it is built for; compiler and libraries
# are those of Debian's multiarch, so that building for another machine differs in nothing but the names.
ARCH ?= $(shell dpkg --print-architecture)
TRIPLET_arm64 := aarch64-linux-gnu
TRIPLET_amd64 := x86_64-linux-gnu
TRIPLET := $(TRIPLET_$(ARCH))
ifeq ($(TRIPLET),)
$(error ARCH=$(ARCH): the panel is built for arm64 and amd64)
endif

O   := build/panel-linux-$(ARCH)
CC  := $(TRIPLET)-gcc
AR  := $(TRIPLET)-gcc-ar
RUN := $(if $(filter $(ARCH),$(shell dpkg --print-architecture)),,qemu-$(firstword $(subst -, ,$(TRIPLET)))-static)
PKG_CONFIG := PKG_CONFIG_LIBDIR=/usr/lib/$(TRIPLET)/pkgconfig:/usr/share/pkgconfig pkg-config

DRIVERS = $(LINUX_DRIVERS)

# Vectors of 64-bit Arm, for which some loops are written anew.
KERNELS := $(if $(filter arm64,$(ARCH)),arm64,c)

# For any processor of its kind: a package does not know where it will be installed.
OPT_core := -O3 -funroll-loops
OPT_rest  = $(OPT_core)
