#!/bin/sh
# netem.sh BUILD-DIR: what training costs: 200 chips of SLICY and of the tank, made by a hidden law, one core. Nothing here
# passes or fails.
set -eu
build=${1:?usage: netem.sh BUILD-DIR}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT INT TERM
epochs=20 pix_epochs=5

# Processor time in s, and the most memory in MB, of one program.
cost() { # program arguments...
    OPENBLAS_NUM_THREADS=1 python3 -c '
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print("%.1f %.0f" % (used.ru_utime + used.ru_stime, used.ru_maxrss / 1024))' "$@"
}

echo "Training on 160 of 200 chips of 54 x 54 pixels, validation on 40: 5 + $epochs + $pix_epochs epochs, one core, with tracing and scores"
echo "  model   processor time    memory"
for model in slicy tank; do
    cost "$build/bin/landmass-netem" recover --model $model --number 200 --share 0.8 --epochs $epochs --pix-epochs $pix_epochs \
        --out "$work/$model" > "$work/cost"
    awk -v model=$model '{ printf "  %-6s %12.1f s %8d MB\n", model, $1, $2 }' "$work/cost"
done
