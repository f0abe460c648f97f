#!/usr/bin/env bash
# Installs what is needed, builds Release into build/ and runs every test.
set -euo pipefail
cd "$(dirname "$0")"
./setup.sh
cmake --preset release >/dev/null
cmake --build --preset release
ctest --test-dir build --output-on-failure --parallel "$(nproc)"
