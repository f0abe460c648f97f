#!/bin/sh
# The reference run of docs/tradeoff.md: the methods for every kind of scene, near the quality of published KFR, on three
# scenes, camera still and moving, one eye of a FOVE and 2560 x 1440. Killed, it goes on when it is started again.
#   PARAFOVEA=build/parafovea KITCHEN=path/to/country_kitchen.glb sh docs/tradeoff_reference.sh OUT
set -e
: "${PARAFOVEA:=build/parafovea}" "${KITCHEN:?where is country_kitchen.glb?}"
out=${1:?a folder for the results}
exec "$PARAFOVEA" tradeoff --scenes "$KITCHEN,atrium,primitives" \
    --sizes 1280x1440@76.7,2560x1440@100 --gaze centre --motion still,path \
    --rounds 1 --frames 2 --reference-samples 1 --out "$out" \
    --setting 'kfr sigma=1.8 alpha=4 culling=0' \
    --setting 'kfr sigma=1.8 alpha=4' \
    --setting 'kfr sigma=1.8 alpha=4 inset=0.09 width_scale=0.4 height_scale=1.9' \
    --setting 'kfr sigma=1.8 inset=0.09 width_scale=0.27 height_scale=1.375 internal_filter=0 kernel=linear_mar' \
    --setting 'rings' \
    --setting 'log_polar' \
    --setting 'rmfr' \
    --setting 'log_rectilinear' \
    --setting 'f3d' \
    --setting 'quad_views focus_width=0.3 focus_height=0.3' \
    --setting 'swafford_resolution density=0.25' \
    --setting 'cps' \
    --setting 'mrs detail=0.1' \
    --setting 'patney taa=8 contrast=0.2' \
    --setting 'ais'
