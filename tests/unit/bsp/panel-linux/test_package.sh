#!/bin/sh
# The panel's program as its user meets it, and the Debian package with everything in it.
set -u
build=${BUILD:-build/bench-linux}
panel=$build/bin/landmass-panel
work=$build/tmp/package
number=0
failed=0
rm -rf "$work"
mkdir -p "$work"

result() { # STATUS STATEMENT
    number=$((number + 1))
    if [ "$1" -eq 0 ]; then
        echo "ok $number - $2"
    else
        failed=1
        echo "not ok $number - $2"
    fi
}

ends_with() { # CODE ARGUMENT...: the program's exit code; what it says goes to $work/said
    expected=$1
    shift
    "$panel" "$@" >"$work/out" 2>"$work/said"
    [ $? -eq "$expected" ]
}

ends_with 0 --help && grep -q '^Usage: landmass-panel' "$work/out" && grep -q 'Exit codes' "$work/out"
result $? '--help explains the options and the exit codes'
ends_with 0 --version && grep -qx 'landmass-panel [0-9.]*' "$work/out"
result $? '--version prints the version'
ends_with 2 --nonsense && grep -q 'no option "--nonsense"' "$work/said" && ends_with 2 --config && ends_with 2 word
result $? 'a command line that makes no sense ends with 2 and says why'
ends_with 1 --config /nowhere/panel.conf && grep -q '/nowhere/panel.conf: No such file' "$work/said"
result $? 'a configuration that was named and is not there ends with 1'
printf '# fine\nseed = 5\n\nseed = 6\nkey.1 = A\nglass.turn = 45\n' >"$work/wrong.conf"
ends_with 1 --check --config "$work/wrong.conf" && grep -q 'wrong.conf line 4: ' "$work/said" &&
    grep -q 'wrong.conf line 6: ' "$work/said" && [ "$(wc -l <"$work/said")" -eq 2 ]
result $? '--check names each wrong line by its number, and no other'
head -c 70000 /dev/zero | tr '\0' '#' >"$work/long.conf"
ends_with 1 --check --config "$work/long.conf" && grep -q 'longer than 64 KiB' "$work/said"
result $? 'a file that is too long is refused'

printf 'glass = none\ncan = nosuch0\nrecord = none\ndatabase.serial = none\n' >"$work/devices.conf"
ends_with 3 --check --devices --config "$work/devices.conf" && grep -q 'can: nosuch0: no such interface' "$work/said" &&
    ends_with 0 --check --config "$work/devices.conf" && ends_with 2 --devices
result $? '--check --devices ends with 3 and names the device; --check alone reads files'

if ! command -v dpkg-deb >/dev/null; then
    echo "ok $((number + 1)) # SKIP the Debian package"
    echo '# skipped: dpkg-deb is missing: this is no Debian system'
    echo "1..$((number + 1))"
    exit $failed
fi
arch=$(dpkg --print-architecture)
package=$(sh bsp/panel-linux/debian/build.sh "$arch" "$panel" "$work")
result $? 'the package can be built'
again=$(sh bsp/panel-linux/debian/build.sh "$arch" "$panel" "$work/again")
cmp "$package" "$again"
result $? 'the same program makes the same package, byte for byte'
dpkg-deb -x "$package" "$work/root" && dpkg-deb -e "$package" "$work/control"
for file in usr/sbin/landmass-panel usr/bin/landmass-load lib/systemd/system/landmass-load@.service \
    lib/systemd/system/landmass-load-usb.service usr/lib/landmass-panel/usb-gadget \
    lib/udev/rules.d/90-landmass-load.rules usr/share/man/man1/landmass-load-put.1.gz \
    usr/share/man/man1/landmass-load-send.1.gz usr/share/man/man1/landmass-load-receive.1.gz \
    usr/share/bash-completion/completions/landmass-load lib/systemd/system/landmass-panel.service lib/udev/rules.d/60-landmass-panel.rules \
    usr/lib/sysctl.d/60-landmass-panel.conf usr/share/man/man8/landmass-panel.8.gz etc/landmass-panel.conf \
    usr/share/doc/landmass-panel/panel.md.gz usr/share/doc/landmass-panel/copyright; do
    [ -s "$work/root/$file" ] || echo "# $file is missing" >>"$work/missing"
done
[ ! -s "$work/missing" ]
result $? 'it holds the program, its service, rules, manual and configuration'
[ "$(cat "$work/control/conffiles")" = /etc/landmass-panel.conf ]
result $? 'the configuration is a conffile: an upgrade keeps what the owner changed'
(cd "$work/root" && md5sum --quiet -c ../control/md5sums)
result $? 'its checksums hold'
dpkg-deb -c "$package" | awk '$2 != "root/root" || $1 ~ /^-.......w/ { print; bad = 1 } END { exit bad }'
result $? 'everything in it belongs to root, and nobody else may write it'
for script in postinst prerm postrm; do
    sh -n "$work/control/$script" && [ -x "$work/control/$script" ] || echo "$script"
done >"$work/scripts"
[ ! -s "$work/scripts" ]
result $? 'its scripts are shell and may be run'

ends_with 0 --check --config "$work/root/etc/landmass-panel.conf"
result $? 'the delivered configuration is right'
sed 's/^#\([a-z]\)/\1/' "$work/root/etc/landmass-panel.conf" >"$work/all.conf"
"$panel" --options | sed -n 's/^\([a-z][^ ]*\) = .*/\1/p' | sort >"$work/options"
ends_with 0 --check --config "$work/all.conf" &&
    sed -n 's/^\([a-z][^ ]*\) = .*/\1/p' "$work/all.conf" | sort | cmp - "$work/options"
result $? 'it names every option once, and what is commented out may be switched on as it stands'
if command -v man >/dev/null; then
    MANWIDTH=200 man --warnings -l "$work/root/usr/share/man/man8/landmass-panel.8.gz" >"$work/page" 2>"$work/said"
    tr -d '\b' <"$work/page" | tr -s ' ' '\n' | sort -u >"$work/words"
    [ ! -s "$work/said" ] && ! comm -23 "$work/options" "$work/words" | grep .
    result $? 'the manual page is well-formed and names every option'
else
    echo "ok $((number = number + 1)) # SKIP the manual page"
    echo '# skipped: man is missing: run make deps'
fi
if command -v systemd-analyze >/dev/null; then
    sed "s|/usr/sbin/landmass-panel|$PWD/$panel|" "$work/root/lib/systemd/system/landmass-panel.service" >"$work/landmass-panel.service"
    sed "s|/usr/bin/landmass-load|$PWD/$build/bin/landmass-load|" "$work/root/lib/systemd/system/landmass-load@.service" \
        >"$work/landmass-load@.service"
    sed -e "s|/usr/bin/landmass-load|$PWD/$build/bin/landmass-load|" -e "s|/usr/lib/landmass-panel|$PWD/$work/root&|" \
        "$work/root/lib/systemd/system/landmass-load-usb.service" >"$work/landmass-load-usb.service"
    systemd-analyze verify --man=no "$work/landmass-panel.service" "$work/landmass-load@sdb1.service" \
        "$work/landmass-load-usb.service" 2>&1 | sed 's/^/# /' |
        grep landmass >"$work/said"
    [ ! -s "$work/said" ] || cat "$work/said"
    [ ! -s "$work/said" ]
    result $? 'systemd finds nothing wrong with its services'
else
    echo "ok $((number = number + 1)) # SKIP systemd finds nothing wrong with the service"
    echo '# skipped: systemd-analyze is missing'
fi
if udevadm verify --help >/dev/null 2>&1; then
    udevadm verify "$work"/root/lib/udev/rules.d/*.rules >"$work/said" 2>&1
    status=$?
    sed 's/^/# /' "$work/said"
    result $status 'udev finds nothing wrong with its rules'
else
    echo "ok $((number = number + 1)) # SKIP udev finds nothing wrong with its rules"
    echo '# skipped: udevadm cannot verify: systemd is older than 254'
fi
if command -v lintian >/dev/null; then
    cp "$package" "$work/stripped.deb"
    lintian --allow-root --fail-on error,warning "$work/stripped.deb" >"$work/said" 2>&1
    status=$?
    sed 's/^/# /' "$work/said"
    result $status 'lintian finds neither errors nor warnings'
else
    echo "ok $((number = number + 1)) # SKIP lintian finds neither errors nor warnings"
    echo '# skipped: lintian is missing: run make deps'
fi
echo "1..$number"
exit $failed
