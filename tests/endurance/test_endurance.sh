#!/bin/sh
# Every clock and counter just before its wrap (make endurance flies on from there). TAP.
exec "${BUILD:-build/bench-linux}/bin/tests/endurance/endurance" wraps
