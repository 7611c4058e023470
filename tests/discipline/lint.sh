#!/bin/sh
# `make lint`: everything that can be found without running the code. It goes on after a finding, and fails at the end
# if there was one.
set -u
cd "$(dirname "$0")/../.." || exit 1
o=build/clang
failed=0

for tool in clang clang-format clang-tidy cppcheck python3; do
    command -v "$tool" >/dev/null || { echo "lint: $tool is missing: run make deps" >&2; exit 1; }
done

step() {
    if "$1"; then
        echo "lint: $2: fine"
    else
        echo "lint: $2: FAILED"
        failed=1
    fi
}

formatting() {
    git ls-files '*.c' '*.h' | xargs clang-format --dry-run -Werror
}

clang_build() {
    make --no-print-directory -s CC=clang O=$o lint-build
}

# cppcheck 2.10 mistakes an array filled through a pointer for an uninitialised one, and `p = q ? q : p` for a leak;
# clang-tidy looks for both as well.
mistakes() {
    rooms=$(printf -- '-I%s ' firmware/*/include)
    libraries=$(printf -- '-I%s ' host-sim/*/include)
    # shellcheck disable=SC2086 # one word for each room
    cppcheck --quiet --std=c11 --enable=warning,performance,portability --inline-suppr --error-exitcode=1 -j2 \
        --suppress=missingIncludeSystem --suppress=missingInclude \
        --suppress=uninitvar --suppress=legacyUninitvar --suppress=memleak \
        -Ifixed/include $rooms -Idrivers/include $libraries \
        fixed firmware drivers bsp host-sim
}

tidiness() {
    make --no-print-directory -Bn CC=clang O=$o lint-build | python3 -B tests/discipline/tidy.py $o
}

scripts() {
    git ls-files '*.sh' .ci | xargs shellcheck --severity=warning
}

step formatting 'clang-format'
step clang_build 'clang without a warning'
step mistakes 'cppcheck'
step tidiness 'clang-tidy'
if command -v shellcheck >/dev/null; then
    step scripts 'shellcheck'
fi
exit $failed
