# web: a browser, or node. The display unit is a module of WebAssembly; JavaScript is its devices (docs/web.md).
WASM_LLVM ?= 19
CC := clang-$(WASM_LLVM)
AR := ar # which knows no such objects: the linker takes archives whole
LD_wasm := wasm-ld-$(WASM_LLVM)
STRIP_wasm := --strip-all # empty: functions keep their names, for a profile

# 128-bit vectors, and instructions that copy and fill memory: every browser since 2021 has both.
OPT := -O3 --target=wasm32 -msimd128 -mbulk-memory -ffreestanding -Wno-unused-command-line-argument
OPT_core :=
OPT_rest :=
KERNELS  := c

# The page brings the devices.
DRIVERS := not_fitted/not_fitted

PARTS := bsp/web/web.mk tests/web/web.mk
