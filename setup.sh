#!/usr/bin/env bash
# Installs the Debian 12 packages that Parafovea needs; does nothing when all are there.
set -euo pipefail
packages=(
    g++ cmake ninja-build ccache
    libvulkan-dev mesa-vulkan-drivers vulkan-validationlayers glslc
    libsqlite3-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libtinygltf-dev libstb-dev libglm-dev
    libmeshoptimizer-dev
    libpng-dev zlib1g-dev libboost-dev gnuplot-nox fonts-dejavu-core
    libopenxr-dev libopenxr-loader1 openxr-layer-corevalidation
    libglfw3-dev libimgui-dev xvfb xauth
    libgtest-dev libgmock-dev libbenchmark-dev
    pkgconf libhidapi-dev libusb-1.0-0-dev umockdev libumockdev-dev
)
missing=()
for package in "${packages[@]}"; do
    dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "setup.sh: run as root to install: ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
fi
echo "setup.sh: installing ${missing[*]}" >&2
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
