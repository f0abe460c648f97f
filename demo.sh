#!/usr/bin/env bash
# Builds Parafovea, simulates the final study with 18 participants and ends with Table 1, Figure 10 and a report.
set -euo pipefail
cd "$(dirname "$0")"
./setup.sh
cmake --preset release >/dev/null
cmake --build --preset release --target parafovea
rm -rf demo_study
build/parafovea simulate protocols/demo.toml --participants 18 --seed 2018 --out demo_study
