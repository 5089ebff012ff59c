// The boundary between the Verilated stitcher and Rust: one call a cycle, plain integers only.
// The structs are those of rtl_model/tests/lockstep/verilated.rs.

#include <cstdint>

#include "Vstitch.h"

struct StitchIn {
    uint16_t outer, inner, end;
    int8_t inner_step;
    uint8_t outer_segments, inner_segments;
    uint8_t cells, lower, mirrored, outer_back;
    uint8_t reset, valid, room;
};

struct StitchOut {
    uint16_t triangle[3];
    uint8_t accept, valid;
};

extern "C" Vstitch *stitch_new() { return new Vstitch; }

extern "C" void stitch_delete(Vstitch *stitch) {
    stitch->final();
    delete stitch;
}

// Settles the outputs for these inputs and reads them, then lets the clock rise.
extern "C" void stitch_cycle(Vstitch *stitch, const StitchIn *in, StitchOut *out) {
    stitch->reset = in->reset;
    stitch->in_valid = in->valid;
    stitch->in_cells = in->cells;
    stitch->in_lower = in->lower;
    stitch->in_mirrored = in->mirrored;
    stitch->in_outer_back = in->outer_back;
    stitch->in_outer = in->outer & 0x7fff;
    stitch->in_inner = in->inner & 0x7fff;
    stitch->in_inner_step = static_cast<uint8_t>(in->inner_step);
    stitch->in_outer_segments = in->outer_segments & 0x7f;
    stitch->in_inner_segments = in->inner_segments & 0x7f;
    stitch->in_end = in->end & 0x3ff;
    stitch->room = in->room;
    stitch->clk = 0;
    stitch->eval();
    out->accept = stitch->in_accept;
    out->valid = stitch->out_valid;
    out->triangle[0] = stitch->out_a;
    out->triangle[1] = stitch->out_b;
    out->triangle[2] = stitch->out_c;
    stitch->clk = 1;
    stitch->eval();
}
