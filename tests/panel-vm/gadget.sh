#!/bin/sh
# A USB device on the port that ends in this very machine (dummy_hcd), with a report descriptor of one's choice.
#   gadget plug DESCRIPTOR    hexadecimal, as one word; it is 1209:0c0d, a number for private use
#   gadget report BYTES       send a report, hexadecimal, at most 8 bytes
#   gadget unplug
set -eu
config=/sys/kernel/config/usb_gadget/stick

bytes() { # HEX
    printf '%b' "$(echo "$1" | sed 's/../\\x&/g')"
}

plug() {
    [ -d /sys/kernel/config/usb_gadget ] || mount -t configfs none /sys/kernel/config
    mkdir -p $config/strings/0x409 $config/configs/c.1 $config/functions/hid.0
    echo 0x1209 >$config/idVendor
    echo 0x0c0d >$config/idProduct
    echo 'Hand controller' >$config/strings/0x409/product
    echo 8 >$config/functions/hid.0/report_length
    bytes "$1" >$config/functions/hid.0/report_desc
    ln -s $config/functions/hid.0 $config/configs/c.1
    echo dummy_udc.0 >$config/UDC
}

unplug() {
    echo '' >$config/UDC
    rm $config/configs/c.1/hid.0
    rmdir $config/functions/hid.0 $config/configs/c.1 $config/strings/0x409 $config
}

case $1 in
plug) plug "$2" ;;
report) bytes "$2" >/dev/hidg0 ;;
unplug) unplug ;;
esac
