#!/bin/sh
# The board that one copies: it compiles, and flies with nothing.
set -u
env -u MAKEFLAGS -u MAKEOVERRIDES make --no-print-directory -s -j2 BOARD=template all
status=$?
[ $status -eq 0 ] || printf 'not '
echo "ok 1 - the template compiles"
timeout -k 2 60 build/template/bin/landmass-template
flown=$?
[ $flown -eq 0 ] || printf 'not '
echo "ok 2 - and flies with nothing, which it says"
echo "1..2"
[ $status -eq 0 ] && [ $flown -eq 0 ]
