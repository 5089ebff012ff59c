#!/usr/bin/env bash
# Everything that can be checked: format, lints, tests, documentation, a run of the command, benches.
#
#   tests/all.sh                 about twenty minutes on two cores, most of it building
#   tests/all.sh --long          the long campaigns too (TESSIM_LONG=1: tests scale their case counts)
#   tests/all.sh --mutants       changes every constant of every kernel, one at a time; an hour
#   tests/all.sh --browser       installs Chromium, does recorded kernels and drives pages in it; pages
#                                without being asked where there is a Chromium
#   tests/all.sh --fuzz SECONDS  then fuzzes each target for that long
#
# Tests that cannot run here print a line with SKIPPED and why; they are listed at the end. With CI=true
# they are failures.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    sed -n '2,12s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
    exit "$1"
}

fuzz_seconds=0
mutants=no
browser=no
while [ $# -gt 0 ]; do
    case "$1" in
        --long) export TESSIM_LONG=1 ;;
        --mutants) mutants=yes ;;
        --browser) browser=yes ;;
        --fuzz)
            fuzz_seconds="${2:-}"
            [[ "$fuzz_seconds" =~ ^[1-9][0-9]*$ ]] || { echo "--fuzz takes seconds" >&2; exit 2; }
            shift
            ;;
        -h | --help) usage 0 ;;
        *) usage 2 >&2 ;;
    esac
    shift
done

log="$(mktemp)"
trap 'rm -f "$log"' EXIT
started=$SECONDS
failed=()

# A step runs to its end whatever became of the ones before: one run shows all that is wrong.
step() {
    local name="$1" begun=$SECONDS
    shift
    echo "== $name"
    if ! "$@" 2>&1 | tee -a "$log"; then
        failed+=("$name")
    fi
    echo "-- $name: $((SECONDS - begun)) s"
}

need() {
    local tool="$1" how="$2"
    command -v "$tool" >/dev/null && return
    echo "missing: $tool; $how" >&2
    exit 3
}

# Debian's C toolchain is all that is needed beside Rust: cargo links with cc. Installed where we may.
if ! command -v cc >/dev/null && command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
    apt-get update -qq && apt-get install -y -qq --no-install-recommends gcc libc6-dev
fi
# Verilator runs the stitcher's SystemVerilog beside the Rust block; Yosys shows that it is hardware.
if ! command -v verilator >/dev/null || ! command -v yosys >/dev/null || ! command -v g++ >/dev/null; then
    if command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
        { apt-get update -qq && apt-get install -y -qq --no-install-recommends \
            verilator yosys g++ make; } >/dev/null || echo "apt-get cannot install verilator, yosys"
    fi
fi
# Mesa's software OpenGL has a tessellator to compare ours with; its software Vulkan runs the second
# implementation. Both are loaded when a test runs.
mesa=(libegl1 libgl1-mesa-dri mesa-vulkan-drivers libvulkan1)
if command -v dpkg >/dev/null && ! dpkg -s "${mesa[@]}" >/dev/null 2>&1; then
    if command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
        { apt-get update -qq && apt-get install -y -qq --no-install-recommends \
            "${mesa[@]}"; } >/dev/null || echo "apt-get cannot install Mesa"
    fi
fi
if [ "$browser" = yes ] && ! command -v chromium >/dev/null && [ "$(id -u)" = 0 ]; then
    { apt-get update -qq && apt-get install -y -qq --no-install-recommends \
        chromium; } >/dev/null || echo "apt-get cannot install chromium"
fi
if [ "$browser" = yes ] || command -v chromium >/dev/null; then
    export TESSIM_BROWSER=1
fi
need cc "install a C compiler (Debian: gcc libc6-dev)"
need cargo "install Rust 1.90 or newer from https://rustup.rs"
need git "install git; a rule of tests/tidy.rs asks it for the tracked files"

smoke() {
    # The built command on a shipped trace; the table must come, and the counters with it.
    local out
    out="$(mktemp -d)"
    # As the tests have built it: by itself cargo would build the dependencies anew, for the package
    # alone asks for fewer of their features than the workspace.
    "${CARGO_TARGET_DIR:-target}/release/tessim" run traces/teapot.jsonl --out "$out/result" --mesh ply
    test -s "$out/result/counters.csv" && test -s "$out/result/mesh.ply"
    rm -rf "$out"
}

# Recorded dispatches, in a browser that brings its own software GPU.
third_witness() {
    local work
    command -v node >/dev/null || { echo "SKIPPED third witness: no node"; return; }
    command -v chromium >/dev/null || { echo "SKIPPED third witness: no chromium"; return; }
    work="$(mktemp -d)"
    npm install --silent --no-audit --no-fund --prefix "$work" playwright-core@1.65.1 &&
        TESSIM_RECORD="$work" cargo test --workspace --features gpu,parquet --release --test gpu records \
            -- --nocapture &&
        NODE_PATH="$work" node tests/browser/witness.mjs "$work"
    local outcome=$?
    rm -rf "$work"
    return $outcome
}

lockstep() {
    command -v g++ >/dev/null || { echo "SKIPPED lock step: no g++"; return; }
    # Of the workspace, for the same reason.
    local what=(--workspace --features gpu,parquet,rtl_model/verilator --test lockstep)
    cargo clippy "${what[@]}" --quiet -- -D warnings &&
        cargo test "${what[@]}" --release -- --nocapture
}

# Cells, and no latch: whatever is not a register is combinational.
synthesis() {
    command -v yosys >/dev/null || { echo "SKIPPED synthesis: no yosys"; return; }
    yosys -q -p 'read_verilog -sv rtl_model/sv/stitch.sv; synth -flatten -top stitch; check -assert
        select -assert-none t:*LATCH*; select -assert-min 100 t:*DFF*; tee -o /dev/stdout stat'
}

fuzz() {
    command -v cargo-fuzz >/dev/null || { echo "SKIPPED fuzz: no cargo-fuzz"; return; }
    [ -f tests/fuzz/Cargo.toml ] || { echo "SKIPPED fuzz: no targets"; return; }
    local target
    for target in $(cargo fuzz list --fuzz-dir tests/fuzz); do
        cargo +nightly fuzz run --fuzz-dir tests/fuzz "$target" -- \
            -max_total_time="$fuzz_seconds" || return 1
    done
}

step "format" cargo fmt --all --check
step "lints" cargo clippy --workspace --features gpu,parquet --all-targets --quiet -- -D warnings
# Optimised: the comparisons with the definitions run millions of cases. Integer overflow stays
# checked, in all that follows: one profile builds the dependencies once. Most of the time goes into
# building thirty test programs: they have no lines for debuggers, and their parts are optimised by
# themselves.
export CARGO_PROFILE_RELEASE_OVERFLOW_CHECKS=true CARGO_PROFILE_RELEASE_DEBUG_ASSERTIONS=true
export CARGO_PROFILE_RELEASE_DEBUG=none CARGO_PROFILE_RELEASE_LTO=off
# --nocapture, or the reasons of skipped tests would not be seen.
# The lock-step test has its own step: its feature would have all crates built twice.
step "tests" cargo test --workspace --features gpu,parquet --release --no-fail-fast --lib --bins --tests -- --nocapture \
    --skip the_hardware_description_keeps_step
step "lock step with the SystemVerilog" lockstep
step "synthesis" synthesis
step "documentation tests" cargo test --workspace --features gpu,parquet --release --doc
step "documentation" env RUSTDOCFLAGS="-D warnings" cargo doc --workspace --features gpu,parquet --no-deps --quiet
step "a run" smoke
step "benches build" cargo bench --workspace --features gpu,parquet --no-run
if [ "$mutants" = yes ]; then
    step "mutants" env TESSIM_MUTANTS=1 cargo test --workspace --features gpu,parquet --release --test gpu \
        mutants -- --nocapture
fi
if [ "$browser" = yes ]; then
    step "third witness" third_witness
fi
if [ "$fuzz_seconds" != 0 ]; then
    step "fuzz" fuzz
fi

mapfile -t skipped < <(grep -a 'SKIPPED' "$log" | sort -u)
if [ ${#skipped[@]} -gt 0 ]; then
    echo "== skipped"
    printf '%s\n' "${skipped[@]}"
    if [ "${CI:-}" = true ]; then
        failed+=("${#skipped[@]} skipped, which CI does not allow")
    fi
fi
passed="$(grep -aoE '[0-9]+ passed' "$log" | awk '{ n += $1 } END { print n + 0 }')"
took=$((SECONDS - started))
if [ ${#failed[@]} -gt 0 ]; then
    echo "FAILED after $took s: $(IFS=';'; echo "${failed[*]}") ($passed tests passed)"
    exit 1
fi
echo "OK: $passed tests passed, ${#skipped[@]} skipped, $took s"
