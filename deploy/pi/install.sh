#!/bin/sh
# Installs the program and its service from the unpacked archive, as the Debian package does. Run it as root.
#
#   sudo ./install.sh
#
# An existing /etc/vibrissa/array.yaml remains. The service is not started.
set -e
cd "$(dirname "$0")"

if [ "$(id -u)" != 0 ]; then
    echo "install.sh: it writes to /usr and /etc; run it as root: sudo ./install.sh" >&2
    exit 1
fi
if [ "$(uname -m)" != aarch64 ]; then
    echo "install.sh: the program is for aarch64, and this machine is $(uname -m); use a 64-bit Raspberry Pi OS" >&2
    exit 1
fi

if [ -d /run/systemd/system ]; then
    # There is no such service before the first installation.
    systemctl stop vibrissa-robot.service 2>/dev/null || true
fi
install -D -m 755 vibrissa-robot /usr/bin/vibrissa-robot
install -D -m 644 vibrissa-robot.service /etc/systemd/system/vibrissa-robot.service
install -D -m 644 99-vibrissa.rules /etc/udev/rules.d/99-vibrissa.rules
if [ -e /etc/vibrissa/array.yaml ]; then
    install -m 644 array.yaml /etc/vibrissa/array.yaml.new
    echo "install.sh: /etc/vibrissa/array.yaml remains; the new example is array.yaml.new beside it"
else
    install -D -m 644 array.yaml /etc/vibrissa/array.yaml
fi
sh debian/postinst configure
echo "Installed. Next: README.md, from step 2 on."
