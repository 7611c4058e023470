#!/bin/sh
# Run a test of the modules of WebAssembly, or say what it lacks. Usage: run.sh PROGRAM...
for tool in wasm-ld-19 node; do
    if ! command -v $tool >/dev/null; then
        echo "ok 1 # SKIP the display in a browser"
        echo "# skipped: $tool is missing: run make deps"
        echo 1..1
        exit 0
    fi
done
exec "$@"
