# The rooms of the firmware, from the ground up, and which others each one may see. A room is compiled with its
# own headers and the public headers of the rooms named here, and with no others: any other include is "No such
# file or directory". `make rooms` prints these arrows beside those that the sources use.
ROOMS        := base table kernels map clutter targets radar bus nav page display unit
SEES_base    :=
SEES_table   := base
SEES_kernels := base
SEES_map     := kernels base
SEES_clutter := kernels table map base
SEES_targets := clutter table map base
SEES_radar   := targets clutter kernels table map base
SEES_bus     := base
SEES_nav     := bus base
SEES_page    := table base
SEES_display := page kernels table base
SEES_unit    := display page nav bus radar targets clutter kernels table map base
SEES_drivers := base

ROOM_HEADERS  = $(patsubst %,-Ifirmware/%/include,$(1))
