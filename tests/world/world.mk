# The workflow of a world (host-sim/world), on this machine and on a cluster; skipped where its packages are missing.
WORLD_TEST := $(O)/bin/tests/world/test_world
TESTS += $(WORLD_TEST)
$(WORLD_TEST): $(wildcard tests/world/*.py host-sim/world/*) $(addprefix $(O)/bin/landmass-,db scene)
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec $${PYTHON:-/usr/bin/python3} -B tests/world/test_world.py\n' >$@
	@chmod +x $@
