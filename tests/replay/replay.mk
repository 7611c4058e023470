# Flights of random events, recorded by one build of the firmware and shown again by others: as the product is built, by
# clang at its highest level, under the sanitizers, and by the panel's processor (as tests/golden does).
REPLAY := $(O)/bin/tests/replay
REPLAY_VARIANTS := $(if $(findstring clang,$(CC))$(findstring coverage,$(O)),,flights-clang flights-sanitized)
REPLAY_PARTS := $(O)/tests/replay/flights.o $(LIB_record) $(LIB_support) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(REPLAY)/flights: $(REPLAY_PARTS)
$(REPLAY)/flights-clang: $(REPLAY_PARTS:$(O)/%=$(O)/clang/%)
$(REPLAY)/flights-sanitized: $(call sanitized,$(REPLAY_PARTS))
$(REPLAY)/flights $(REPLAY)/flights-clang: LDLIBS = $(call pkgs,libs,libpng)
$(REPLAY)/flights-sanitized: LDLIBS = $(LINK_sanitized) $(call pkgs,libs,libpng)

TESTS += $(REPLAY)/test_replay
$(REPLAY)/test_replay: tests/replay/test_replay.sh $(addprefix $(REPLAY)/,flights $(REPLAY_VARIANTS)) replay-arm64 | $(O)/bin/landmass-sim $(PANEL)
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@

.PHONY: replay-arm64
replay-arm64: | golden-arm64 # makes of one folder, one after the other
ifeq ($(BOARD),bench-linux)
	@! command -v aarch64-linux-gnu-gcc >/dev/null || $(call make_board,panel-linux) ARCH=arm64 \
	    O=build/panel-linux-arm64 \
	    $(addprefix build/panel-linux-arm64/bin/,tests/replay/flights landmass-panel)
endif

# make flights: the proof in full, on this machine's two compilers and the panel's processor.
FLIGHTS ?= 1000
.PHONY: flights
flights: $(addprefix $(REPLAY)/,flights flights-clang) $(O)/bin/landmass-sim $(PANEL) replay-arm64 ## Record FLIGHTS=1000 flights of random events; show them again by other builds
	@sh tests/replay/test_replay.sh $(FLIGHTS)
