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
    /// The fixed-function tessellator: its factors.
    D3d11,
    /// Its points.
    D3d11Points,
    /// Its primitives.
    D3d11Connect,
    /// The hull shader.
    D3d11Hull,
    /// The domain shader.
    D3d11Domain,
    /// What both and the tessellator did.
    D3d11Count,
    /// What the tessellator's kernels share.
    Rings,
    /// Singles made of integers.
    Single,
    /// The same one by one, for comparisons.
    SingleOperations,
    /// The surface-level shader.
    Esc,
}

/// The two texts that stand before every kernel.
const SHARED: [(&str, &str); 2] = [
    ("number.wgsl", include_str!("number.wgsl")),
    ("settings.wgsl", include_str!("settings.wgsl")),
];

impl Kernel {
    /// All of them, in the order of the data.
    pub const ALL: [Self; 19] = [
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
        Self::D3d11Points,
        Self::D3d11Connect,
        Self::D3d11Hull,
        Self::D3d11Domain,
        Self::D3d11Count,
        Self::Rings,
        Self::Single,
        Self::SingleOperations,
        Self::Esc,
    ];

    /// The name of its file in `src/gpu`.
    #[must_use]
    pub const fn file(self) -> &'static str {
        self.embedded().0
    }

    /// The kernel whose text stands before this one's.
    const fn base(self) -> Option<Self> {
        match self {
            Self::D3d11 | Self::D3d11Points | Self::D3d11Connect => Some(Self::Rings),
            Self::D3d11Hull | Self::D3d11Domain | Self::SingleOperations => Some(Self::Single),
            _ => None,
        }
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
            Self::D3d11Points => ("d3d11_points.wgsl", include_str!("d3d11_points.wgsl")),
            Self::D3d11Connect => ("d3d11_connect.wgsl", include_str!("d3d11_connect.wgsl")),
            Self::D3d11Hull => ("d3d11_hull.wgsl", include_str!("d3d11_hull.wgsl")),
            Self::D3d11Domain => ("d3d11_domain.wgsl", include_str!("d3d11_domain.wgsl")),
            Self::D3d11Count => ("d3d11_count.wgsl", include_str!("d3d11_count.wgsl")),
            Self::Rings => ("d3d11_rings.wgsl", include_str!("d3d11_rings.wgsl")),
            Self::Single => ("single.wgsl", include_str!("single.wgsl")),
            Self::SingleOperations => {
                ("single_operations.wgsl", include_str!("single_operations.wgsl"))
            }
            Self::Esc => ("esc.wgsl", include_str!("esc.wgsl")),
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
        SHARED.iter().map(|(name, _)| *name).chain(Kernel::ALL.map(Kernel::file))
    }

    /// The shipped text of a file.
    #[must_use]
    pub fn shipped(file: &str) -> Option<&'static str> {
        let all = SHARED.into_iter().chain(Kernel::ALL.map(Kernel::embedded));
        all.into_iter().find(|(name, _)| *name == file).map(|(_, text)| text)
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
        let own = kernel.base().into_iter().chain([kernel]).map(Kernel::embedded);
        let texts = SHARED.into_iter().chain(own).map(|(name, text)| self.of(name, text));
        texts.collect::<Vec<_>>().join("\n")
    }
}
