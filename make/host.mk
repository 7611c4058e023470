# How host libraries and programs are declared in host-sim/host-sim.mk. Each declaration is one line: from it
# come the flags to compile a folder with, what it is linked with, and the arrows that `make rooms` prints.
# Tests name what they see in the same words (tests/unit/unit.mk).
#
# SEES is a list of libraries declared before, and of these:
#   fixed, firmware, drivers   the layers: their public headers and their archives
#   firmware.h                 public headers of the firmware, without its code
#   bench                      the bench board
# The headers of a part are its own and the public ones of what it sees. Any other include is "No such file
# or directory". A part is linked with what it sees, and with what that needs.
# PACKAGES are names of pkg-config, or options of the linker.

HOST_LIBS     :=
HOST_PROGRAMS :=
HOST_HEADERS_fixed      := $(INC_fixed)
HOST_HEADERS_firmware   := $(call ROOM_HEADERS,$(ROOMS))
HOST_HEADERS_firmware.h := $(HOST_HEADERS_firmware)
HOST_HEADERS_drivers    := -Idrivers/include
HOST_HEADERS_bench      := -Ibsp/bench-linux -Ibsp/record
LIB_bench := $(O)/libbench.a
$(LIB_bench): $(call objs,$(wildcard bsp/bench-linux/*.c) $(RECORD_SOURCES))
# Recorder and replay, which boards with files share.
LIB_record := $(O)/librecord.a
$(call archive, $(LIB_record), $(RECORD_SOURCES) drivers/can/can_line.c)

# The libraries $(1) and all below them, in the order of linking.
host_needs    = $(filter $(1) $(foreach l,$(1),$(HOST_NEEDS_$l)),$(HOST_LIBS))
# The layers among the names $(1) and among those that the libraries see.
host_layers   = $(filter $(1) $(foreach l,$(call host_needs,$(1)),$(HOST_SEES_$l)),bench drivers firmware fixed)
host_archives = $(foreach l,$(call host_needs,$(1)),$(O)/host-sim/$l/lib$l.a) \
    $(foreach l,bench drivers firmware fixed,$(if $(filter $l,$(call host_layers,$(1))),$(LIB_$l)))
host_packages = $(sort $(foreach l,$(call host_needs,$(1)),$(HOST_PACKAGES_$l)))
# Packages $(1) as flags of the linker, those that nothing is taken from left out.
host_pkg_libs = -Wl,--as-needed $(filter -%,$(1)) $(call pkgs,libs,$(filter-out -%,$(1)))
host_links    = $(call host_pkg_libs,$(call host_packages,$(1)))
host_headers  = $(sort $(foreach l,$(1),$(or $(HOST_HEADERS_$l),-Ihost-sim/$l/include)))
host_cflags   = $(call host_headers,$(1)) $(call pkgs,cflags,$(filter-out -%,$(call host_packages,$(1))))
# All flags of a library, or of programs/NAME.
CFLAGS_host_part = $(CSTD) $(WARN) $(OPT) -D_GNU_SOURCE \
    $(call host_cflags,$(filter-out programs/%,$(1)) $(HOST_SEES_$(1)))

# $(call host_library,NAME,SEES,PACKAGES): host-sim/NAME/*.c, with public headers in include/NAME/ there.
define host_library_rules
$(foreach l,$(2),$(if $(or $(HOST_HEADERS_$l),$(filter $l,$(HOST_LIBS))),,\
    $(error $(1) sees $l, which is not declared before it)))
HOST_SEES_$(1)     := $(2)
HOST_PACKAGES_$(1) := $(3)
HOST_NEEDS_$(1)    := $(call host_needs,$(2))
HOST_LIBS          := $(1) $(HOST_LIBS)
$$(call archive, $(O)/host-sim/$(1)/lib$(1).a, $(wildcard host-sim/$(1)/*.c))
endef
define host_library_flags
$(O)/host-sim/$(1)/%.o: CFLAGS_part := $(call CFLAGS_host_part,$(1))
endef
host_library = $(eval $(call host_library_rules,$(strip $(1)),$(strip $(2)),$(strip $(3)))) \
    $(eval $(call host_library_flags,$(strip $(1))))

# $(call host_program,NAME,SEES,PACKAGES): host-sim/programs/NAME/*.c, which become bin/landmass-NAME.
# host_generator is the same for a program that makes sources, built where make/generated.mk says.
define host_program_rules
HOST_PROGRAMS += $(1)
HOST_SEES_programs/$(1) := $(2)
$(O)/host-sim/programs/$(1)/%.o: CFLAGS_part := $$(call CFLAGS_host_part,programs/$(1))
$(O)/bin/landmass-$(1): $(call objs,$(wildcard host-sim/programs/$(1)/*.c)) $(call host_archives,$(2))
$(O)/bin/landmass-$(1): LDLIBS = $$(call host_links,$(2)) $(if $(3),$$(call pkgs,libs,$(3)))
endef
host_generator = $(eval $(call host_program_rules,$(strip $(1)),$(strip $(2)),$(strip $(3))))
host_program   = $(call host_generator,$(1),$(2),$(3))$(eval PROGRAMS += $(O)/bin/landmass-$(strip $(1)))
