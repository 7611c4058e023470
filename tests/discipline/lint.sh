#!/bin/sh
# `make lint`: everything that can be found without running the code. It goes on after a finding; each kind of finding is
# one failure of the sum in the last line.
set -u
cd "$(dirname "$0")/../.." || exit 1
clang=${CLANG:-clang-19}
o=build/$clang
passed=0
failed=0

for tool in "$clang" clang-format clang-tidy cppcheck shellcheck python3; do
    command -v "$tool" >/dev/null || { echo "lint: $tool is missing: run make deps" >&2; exit 1; }
done

step() { # FUNCTION NAME
    if "$1"; then
        echo "lint: $2: fine"
        passed=$((passed + 1))
    else
        echo "lint: $2: FAILED"
        failed=$((failed + 1))
    fi
}

formatting() {
    git ls-files '*.c' '*.h' | xargs clang-format --dry-run -Werror
}

# The same folder as that of `make check-clang`, so that each source is compiled once.
clang_build() {
    make --no-print-directory -s -j2 CC="$clang" O="$o" lint-build
}

# cppcheck 2.10 mistakes an array filled through a pointer for an uninitialised one, and `p = q ? q : p` for a leak;
# clang-tidy looks for both as well.
mistakes() {
    headers=$(printf -- '-I%s ' firmware/*/include host-sim/*/include)
    # shellcheck disable=SC2086 # one word for each folder
    cppcheck --quiet --std=c11 --enable=warning,performance,portability --inline-suppr --error-exitcode=1 -j2 \
        --suppress=missingIncludeSystem --suppress=missingInclude \
        --suppress=uninitvar --suppress=legacyUninitvar --suppress=memleak \
        -Ifixed/include $headers -Idrivers/include fixed firmware drivers bsp host-sim
}

tidiness() {
    make --no-print-directory -Bn CC="$clang" O="$o" lint-build | python3 -B tests/discipline/tidy.py "$o"
}

scripts() {
    git ls-files '*.sh' .ci | xargs shellcheck --severity=warning
}

documents() {
    python3 -B tests/discipline/prose.py
}

step formatting 'clang-format'
step clang_build "$clang without a warning"
step mistakes 'cppcheck'
step tidiness 'clang-tidy'
step scripts 'shellcheck'
step documents 'documents'
echo "$passed passed, $failed failed, 0 skipped"
[ $failed -eq 0 ]
