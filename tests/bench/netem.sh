#!/bin/sh
# netem.sh BUILD-DIR: what training costs: 200 chips of SLICY and of the tank, made by a hidden law, one core; then the same
# training in PyTorch (Debian: python3-torch), where it is installed. Nothing here passes or fails.
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

# The very same training twice: inputs, chips, first weights, batches and number of threads.
python=${PYTHON:-/usr/bin/python3}
peer_epochs=10
echo
if ! "$python" -c 'import torch' 2> /dev/null; then
    echo "No PyTorch here (Debian: python3-torch): training not compared"
    exit 0
fi
echo "Two EP8 networks on 16 chips of SLICY, $peer_epochs epochs, one thread:"
echo "  program            s of processor an epoch   loss before      after"
OPENBLAS_NUM_THREADS=1 "$build/bin/tests/bench/netem_peer" "$work/paths" $peer_epochs > "$work/ours"
line() { # name word file
    awk -v name="$1" -v word="$2" '$1 == "loss-before" { before = $2 }
        $1 == word { printf "  %-18s %23.4f   %.9f   %.9f\n", name, $2, before, $3 }' "$3"
}
line "ours, double" ours "$work/ours"
for way in double float; do
    "$python" -P -B "$(dirname "$0")/netem_peer.py" "$work/paths" $peer_epochs $way > "$work/torch"
    line "PyTorch, $way" torch "$work/torch"
done
