#!/bin/sh
# Half a minute of the soak (make soak flies an hour): a bus that is never idle loses nothing. TAP.
bin=${BUILD:-build/bench-linux}/bin/tests/bench/soak
echo 1..1
if said=$("$bin" 30); then
    echo "ok 1 - two displays lose no frame of a full bus"
else
    echo "not ok 1 - two displays lose no frame of a full bus"
fi
echo "$said" | sed 's/^/# /'
