//! The units whose patches have lists of parameters, `hybrid`, `triangles`, `moreton` and `sfarti`:
//! their blocks behind the levels.

mod blocks;

pub use blocks::{
    COUNTED, EVENTS, PLAN, Placed, Placing, Source, Starts, degenerate, emit, evaluate, place,
    stitch,
};
