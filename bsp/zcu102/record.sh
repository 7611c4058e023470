#!/bin/sh
# Keep what a board records on its serial line: a file for each start of the board, named as a panel's. Ctrl+C ends it.
# Usage: record.sh TTY FOLDER; TTY may be - for the standard input.
set -eu
if [ $# -ne 2 ]; then
    echo "usage: record.sh TTY FOLDER" >&2
    exit 2
fi
line=$1
folder=$2
mkdir -p "$folder"
if [ "$line" != - ]; then
    exec <"$line"
    stty 2000000 raw -echo -cstopb -parenb -crtscts clocal
fi
last=$(find "$folder" -name 'flight-?????-000.log' | sort | sed -n '$s/.*flight-\(.....\)-.*/\1/p')
echo "record.sh: listening to $line at 2,000,000 baud"
# What comes before the first head, such as noise while the board has no power, is no part of a recording. Behind a pipe
# awk takes a zero byte for what it is; at a terminal some lose the rest of its line.
cat | LC_ALL=C awk -v folder="$folder" -v number="${last:-0}" '
    { is_head = $0 ~ /^\([0-9]+\.[0-9]+\) unit 1F4C4D00#/ }
    is_head && !was_head {
        if (file) close(file)
        file = sprintf("%s/flight-%05d-000.log", folder, ++number)
        print "record.sh: the board began; " file
        fflush()
    }
    { was_head = is_head }
    file { print >file; fflush(file) }'
