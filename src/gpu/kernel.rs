//! The kernels' texts: one WGSL file a block, behind two that all of them share.

use crate::error::{Error, Result};
use std::path::Path;

/// A block's kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kernel {
    /// Sums over patches.
    Scan,
    /// The integers themselves, for comparisons.
    Number,
    /// Trivial clipping.
    Clip,
    /// Back-face removal.
    Backface,
    /// Levels and dyadic lists.
    Level,
    /// Parameters.
    Place,
    /// Points.
    Evaluate,
    /// Triangles.
    Stitch,
    /// Screen positions.
    Emit,
    /// The fixed-function tessellator.
    D3d11,
    /// The surface-level shader's levels of resolution.
    EscLevel,
    /// Its samples and tests.
    Esc,
    /// Its strips, and what it costs.
    EscMesh,
}

/// The two texts that stand before every kernel.
const SHARED: [(&str, &str); 2] = [
    ("number.wgsl", include_str!("number.wgsl")),
    ("settings.wgsl", include_str!("settings.wgsl")),
];

/// What stands between those and the texts of the surface-level shader.
const PATTERN: (&str, &str) = ("esc_pattern.wgsl", include_str!("esc_pattern.wgsl"));
const STRIP: (&str, &str) = ("esc_strip.wgsl", include_str!("esc_strip.wgsl"));
/// And behind one of them.
const COUNT: (&str, &str) = ("esc_count.wgsl", include_str!("esc_count.wgsl"));

impl Kernel {
    /// All of them, in the order of the data.
    pub const ALL: [Self; 13] = [
        Self::Number,
        Self::Scan,
        Self::Clip,
        Self::Backface,
        Self::Level,
        Self::Place,
        Self::Evaluate,
        Self::Stitch,
        Self::Emit,
        Self::D3d11,
        Self::EscLevel,
        Self::Esc,
        Self::EscMesh,
    ];

    /// The name of its file in `src/gpu`.
    #[must_use]
    pub const fn file(self) -> &'static str {
        self.embedded().0
    }

    const fn embedded(self) -> (&'static str, &'static str) {
        match self {
            Self::Number => ("operations.wgsl", include_str!("operations.wgsl")),
            Self::Scan => ("scan.wgsl", include_str!("scan.wgsl")),
            Self::Clip => ("clip.wgsl", include_str!("clip.wgsl")),
            Self::Backface => ("backface.wgsl", include_str!("backface.wgsl")),
            Self::Level => ("level.wgsl", include_str!("level.wgsl")),
            Self::Place => ("place.wgsl", include_str!("place.wgsl")),
            Self::Evaluate => ("evaluate.wgsl", include_str!("evaluate.wgsl")),
            Self::Stitch => ("stitch.wgsl", include_str!("stitch.wgsl")),
            Self::Emit => ("emit.wgsl", include_str!("emit.wgsl")),
            Self::D3d11 => ("d3d11.wgsl", include_str!("d3d11.wgsl")),
            Self::EscLevel => ("esc_level.wgsl", include_str!("esc_level.wgsl")),
            Self::Esc => ("esc.wgsl", include_str!("esc.wgsl")),
            Self::EscMesh => ("esc_mesh.wgsl", include_str!("esc_mesh.wgsl")),
        }
    }

    /// The texts besides its own that only some kernels have.
    const fn parts(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::EscLevel | Self::Esc => &[PATTERN],
            Self::EscMesh => &[PATTERN, STRIP, COUNT],
            _ => &[],
        }
    }
}

/// The texts that a device compiles: the shipped ones, with some of them replaced to see what a
/// change does.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    replaced: Vec<(String, String)>,
}

impl Sources {
    /// The names of all files.
    pub fn files() -> impl Iterator<Item = &'static str> {
        Self::all().map(|(name, _)| name)
    }

    fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
        let some = [PATTERN, STRIP, COUNT];
        SHARED.into_iter().chain(some).chain(Kernel::ALL.map(Kernel::embedded))
    }

    /// The shipped text of a file.
    #[must_use]
    pub fn shipped(file: &str) -> Option<&'static str> {
        Self::all().find(|(name, _)| *name == file).map(|(_, text)| text)
    }

    /// The same, but for one file.
    #[must_use]
    pub fn with(mut self, file: &str, text: String) -> Self {
        self.replaced.retain(|(name, _)| name != file);
        self.replaced.push((file.to_owned(), text));
        self
    }

    /// The texts as they stand in a folder: for work on kernels without a build.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn from_folder(folder: &Path) -> Result<Self> {
        let mut sources = Self::default();
        for file in Self::files() {
            let path = folder.join(file);
            let text =
                std::fs::read_to_string(&path).map_err(|e| Error::system(path.clone(), e))?;
            sources = sources.with(file, text);
        }
        Ok(sources)
    }

    fn of(&self, file: &'static str, text: &'static str) -> &str {
        self.replaced.iter().find(|(name, _)| name == file).map_or(text, |(_, text)| text)
    }

    /// The whole text of a kernel.
    pub(super) fn text(&self, kernel: Kernel) -> String {
        let parts = SHARED.iter().chain(kernel.parts()).copied().chain([kernel.embedded()]);
        let texts: Vec<&str> = parts.map(|(name, text)| self.of(name, text)).collect();
        texts.join("\n")
    }
}
