//! What every kernel is told: `Settings` of settings.wgsl, field by field; and patches as words.

use crate::config::{BackfaceMethod, Config, Overflow, Rounding, Scheme, Termination};
use rtl_model::number::Format;
use rtl_model::patch::{Depth, Patch, View};

/// Words of a patch in its buffer.
pub const PATCH: usize = 136;

/// Words of a vertex: four coordinates of two words, u, v.
pub const VERTEX: usize = 10;

/// The uniform of every kernel: words, as settings.wgsl declares them.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[expect(missing_docs, reason = "settings.wgsl says what each is")]
pub struct Settings {
    pub items: u32,
    pub first: u32,
    pub width: u32,
    pub rounding: u32,
    pub wraps: u32,
    pub guard: u32,
    pub scheme: u32,
    pub viewport: [u32; 2],
    pub depth: u32,
    pub near: [u32; 2],
    pub facing: u32,
    pub clip: u32,
    pub backface: u32,
    pub termination: u32,
    pub subpixel_bits: u32,
    pub emit_rounding: u32,
    pub reciprocal_bits: u32,
    /// A kernel's own.
    pub own: [u32; 16],
}

impl Settings {
    /// The settings of a frame, whose vertices have the format `position`.
    #[must_use]
    pub fn new(config: &Config, view: &View, position: Format) -> Self {
        Self {
            width: position.width,
            rounding: rounding(config.evaluate.rounding),
            wraps: u32::from(config.position.overflow == Overflow::Wrap),
            guard: config.guard(),
            scheme: match config.scheme() {
                Scheme::Forward => 0,
                Scheme::Mixed => 1,
                Scheme::DeCasteljau => 2,
            },
            viewport: view.viewport,
            depth: u32::from(view.depth == Depth::MinusOneToOne),
            near: words(view.near),
            facing: words(view.facing)[0],
            clip: config.clip.enabled.into(),
            backface: match config.backface.method {
                BackfaceMethod::Off => 0,
                BackfaceMethod::NetFacets => 1,
                BackfaceMethod::TangentPlane => 2,
                BackfaceMethod::NormalCone => 3,
                BackfaceMethod::HullLiteral => 4,
            },
            termination: u32::from(config.level.termination == Termination::Bounded),
            subpixel_bits: config.emit.subpixel_bits,
            emit_rounding: rounding(config.emit.rounding),
            reciprocal_bits: config.place.reciprocal_bits,
            ..Self::default()
        }
    }

    /// The same for so many items.
    #[must_use]
    pub fn of(self, items: usize) -> Self {
        Self {
            items: u32::try_from(items).expect("a batch's items are counted in 32 bits"),
            ..self
        }
    }
}

/// A mode's number.
#[must_use]
pub fn rounding(mode: Rounding) -> u32 {
    match mode {
        Rounding::Floor => 0,
        Rounding::NearestUp => 1,
        Rounding::NearestEven => 2,
        Rounding::NearestAway => 3,
    }
}

/// Low word, high word.
#[must_use]
pub fn words(value: i64) -> [u32; 2] {
    [value as u32, (value >> 32) as u32]
}

/// The integer of two words.
#[must_use]
pub fn integer(words: [u32; 2]) -> i64 {
    i64::from(words[1] as i32) << 32 | i64::from(words[0])
}

/// A draw's tessellation state: criterion (0 flatness, 1 edge length, 2 fixed), its number, least
/// and greatest level.
pub type State = [u32; 4];

/// Appends the words of a patch: as settings.wgsl says.
pub fn push_patch(out: &mut Vec<u32>, patch: &Patch, state: State, own: [u32; 3]) {
    out.extend(patch.points.iter().flatten().flat_map(|&c| words(c)));
    let flags = [patch.saturated, patch.cull, patch.reversed];
    out.push((0..3).map(|k| u32::from(flags[k]) << k).sum());
    out.extend(state);
    out.extend(own);
}
