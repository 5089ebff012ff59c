//! The Verilated stitcher: pins in, pins out, a cycle a call.
//!
//! The one place where `unsafe` is needed: Verilator makes C++, and Rust cannot see what is behind
//! a C interface. `sv/stitch_shim.cpp` keeps it to three functions and two structs of integers.

#![expect(unsafe_code, reason = "the boundary to C++ that Verilator made")]

use rtl_model::patch::Triangle;
use rtl_model::strip::{Kind, Strip};
use std::ptr::NonNull;

/// The shim's `StitchIn`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Inputs {
    outer: u16,
    inner: u16,
    end: u16,
    inner_step: i8,
    outer_segments: u8,
    inner_segments: u8,
    cells: u8,
    lower: u8,
    mirrored: u8,
    outer_back: u8,
    reset: u8,
    valid: u8,
    room: u8,
}

impl Inputs {
    /// A cycle's inputs: the strip at the FIFO's head, and whether the FIFO behind has room.
    pub(crate) fn of(strip: Option<&Strip>, room: bool) -> Self {
        let room = room.into();
        let Some(strip) = strip else {
            return Self { room, ..Self::default() };
        };
        let (outer_step, inner_step) = (strip.outer.step, strip.inner.step);
        assert!(outer_step.abs() == 1, "the outer row's step is a sign");
        Self {
            outer: strip.outer.first,
            inner: strip.inner.first,
            end: strip.end,
            inner_step: inner_step.try_into().expect("-127..=127"),
            outer_segments: strip.outer_segments,
            inner_segments: strip.inner_segments,
            cells: matches!(strip.kind, Kind::Cells { .. }).into(),
            lower: matches!(strip.kind, Kind::Cells { lower: true }).into(),
            mirrored: strip.mirrored.into(),
            outer_back: (outer_step < 0).into(),
            reset: 0,
            valid: 1,
            room,
        }
    }
}

/// The shim's `StitchOut`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Outputs {
    triangle: Triangle,
    accept: u8,
    valid: u8,
}

impl Outputs {
    /// Whether the strip is taken in this cycle.
    pub(crate) fn accepts(&self) -> bool {
        self.accept != 0
    }

    /// The triangle that leaves in this cycle.
    pub(crate) fn triangle(&self) -> Option<Triangle> {
        (self.valid != 0).then_some(self.triangle)
    }
}

/// What only C++ knows.
#[repr(C)]
struct Opaque {
    _private: [u8; 0],
}

unsafe extern "C" {
    fn stitch_new() -> *mut Opaque;
    fn stitch_delete(stitch: *mut Opaque);
    fn stitch_cycle(stitch: *mut Opaque, inputs: *const Inputs, outputs: *mut Outputs);
}

/// The stitcher.
pub(crate) struct Stitcher(NonNull<Opaque>);

impl Stitcher {
    /// A stitcher that has been reset.
    pub(crate) fn new() -> Self {
        // SAFETY: no arguments; the pointer is owned by the value that is made here.
        let made = unsafe { stitch_new() };
        let mut stitcher = Self(NonNull::new(made).expect("C++ new returns no null"));
        stitcher.cycle(&Inputs { reset: 1, ..Inputs::default() });
        stitcher
    }

    /// One cycle: the outputs that go with these inputs, and then the clock's edge.
    pub(crate) fn cycle(&mut self, inputs: &Inputs) -> Outputs {
        let mut outputs = Outputs::default();
        // SAFETY: the object lives until `drop`; both structs are the shim's, field by field, and
        // live for the call, which keeps no pointer.
        unsafe { stitch_cycle(self.0.as_ptr(), inputs, &mut outputs) };
        outputs
    }
}

impl Drop for Stitcher {
    fn drop(&mut self) {
        // SAFETY: made by `stitch_new`, and never used again.
        unsafe { stitch_delete(self.0.as_ptr()) };
    }
}
