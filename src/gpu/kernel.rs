//! The kernels' texts: WGSL files, of which a kernel has some, behind two that all of them share.

use crate::error::{Error, Result};
use std::path::Path;

/// A block's kernel, or a part of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kernel {
    /// The integers themselves, for comparisons.
    Number,
    /// Sums over patches.
    Scan,
    /// Trivial clipping.
    Clip,
    /// Back-face removal: by tangent planes and by facets.
    Backface,
    /// By the convex hull.
    BackfaceHull,
    /// By cones.
    BackfaceCone,
    /// Levels.
    Level,
    /// Dyadic lists, by curves that are divided.
    Curve,
    /// Parameters.
    Place,
    /// Points.
    Evaluate,
    /// Tangent planes.
    Normal,
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
    /// Singles made of integers, one operation at a time, for comparisons.
    SingleOperations,
    /// Levels of resolution of the surface-level shader.
    EscLevel,
    /// Its tests.
    Esc,
    /// Its points and strips.
    EscMesh,
}

/// All texts, by their names in `src/gpu`.
const TEXTS: &[(&str, &str)] = &[
    ("number.wgsl", include_str!("number.wgsl")),
    ("settings.wgsl", include_str!("settings.wgsl")),
    ("operations.wgsl", include_str!("operations.wgsl")),
    ("owner.wgsl", include_str!("owner.wgsl")),
    ("vertex.wgsl", include_str!("vertex.wgsl")),
    ("scan.wgsl", include_str!("scan.wgsl")),
    ("clip.wgsl", include_str!("clip.wgsl")),
    ("backface.wgsl", include_str!("backface.wgsl")),
    ("backface_hull.wgsl", include_str!("backface_hull.wgsl")),
    ("backface_cone.wgsl", include_str!("backface_cone.wgsl")),
    ("level.wgsl", include_str!("level.wgsl")),
    ("level_curve.wgsl", include_str!("level_curve.wgsl")),
    ("plan.wgsl", include_str!("plan.wgsl")),
    ("place.wgsl", include_str!("place.wgsl")),
    ("evaluate.wgsl", include_str!("evaluate.wgsl")),
    ("normal.wgsl", include_str!("normal.wgsl")),
    ("stitch.wgsl", include_str!("stitch.wgsl")),
    ("emit.wgsl", include_str!("emit.wgsl")),
    ("d3d11_rings.wgsl", include_str!("d3d11_rings.wgsl")),
    ("d3d11.wgsl", include_str!("d3d11.wgsl")),
    ("d3d11_points.wgsl", include_str!("d3d11_points.wgsl")),
    ("d3d11_connect.wgsl", include_str!("d3d11_connect.wgsl")),
    ("d3d11_count.wgsl", include_str!("d3d11_count.wgsl")),
    ("single.wgsl", include_str!("single.wgsl")),
    ("single_operations.wgsl", include_str!("single_operations.wgsl")),
    ("d3d11_hull.wgsl", include_str!("d3d11_hull.wgsl")),
    ("d3d11_domain.wgsl", include_str!("d3d11_domain.wgsl")),
    ("esc_pattern.wgsl", include_str!("esc_pattern.wgsl")),
    ("esc_level.wgsl", include_str!("esc_level.wgsl")),
    ("esc.wgsl", include_str!("esc.wgsl")),
    ("esc_strip.wgsl", include_str!("esc_strip.wgsl")),
    ("esc_count.wgsl", include_str!("esc_count.wgsl")),
    ("esc_mesh.wgsl", include_str!("esc_mesh.wgsl")),
];

/// The texts that stand before every kernel's own.
const SHARED: &[&str] = &["number.wgsl", "settings.wgsl"];

impl Kernel {
    /// The names of its own texts, in order; the last one has its entries.
    const fn own(self) -> &'static [&'static str] {
        match self {
            Self::Number => &["operations.wgsl"],
            Self::Scan => &["scan.wgsl"],
            Self::Clip => &["clip.wgsl"],
            Self::Backface => &["backface.wgsl"],
            Self::BackfaceHull => &["backface.wgsl", "backface_hull.wgsl"],
            Self::BackfaceCone => &["backface.wgsl", "backface_cone.wgsl"],
            Self::Level => &["level.wgsl"],
            Self::Curve => &["level.wgsl", "level_curve.wgsl"],
            Self::Place => &["plan.wgsl", "place.wgsl"],
            Self::Evaluate => &["plan.wgsl", "owner.wgsl", "evaluate.wgsl"],
            Self::Normal => &["owner.wgsl", "normal.wgsl"],
            Self::Stitch => &["plan.wgsl", "owner.wgsl", "vertex.wgsl", "stitch.wgsl"],
            Self::Emit => &["emit.wgsl"],
            Self::D3d11 => &["d3d11_rings.wgsl", "d3d11.wgsl"],
            Self::D3d11Points => &["owner.wgsl", "d3d11_rings.wgsl", "d3d11_points.wgsl"],
            Self::D3d11Connect => &["owner.wgsl", "d3d11_rings.wgsl", "d3d11_connect.wgsl"],
            Self::D3d11Hull => &["single.wgsl", "d3d11_hull.wgsl"],
            Self::D3d11Domain => &["owner.wgsl", "single.wgsl", "d3d11_domain.wgsl"],
            Self::D3d11Count => &["owner.wgsl", "vertex.wgsl", "d3d11_count.wgsl"],
            Self::SingleOperations => &["single.wgsl", "single_operations.wgsl"],
            Self::EscLevel => &["esc_pattern.wgsl", "esc_level.wgsl"],
            Self::Esc => &["esc_pattern.wgsl", "esc.wgsl"],
            Self::EscMesh => {
                &["esc_pattern.wgsl", "esc_strip.wgsl", "esc_count.wgsl", "esc_mesh.wgsl"]
            }
        }
    }

    /// The name of the file that has its entries.
    #[must_use]
    pub const fn file(self) -> &'static str {
        let own = self.own();
        own[own.len() - 1]
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
        TEXTS.iter().map(|&(name, _)| name)
    }

    /// The shipped text of a file.
    #[must_use]
    pub fn shipped(file: &str) -> Option<&'static str> {
        TEXTS.iter().find(|(name, _)| *name == file).map(|&(_, text)| text)
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

    /// The names of the files that make a kernel, in order.
    pub(super) fn parts(kernel: Kernel) -> Vec<&'static str> {
        [SHARED, kernel.own()].concat()
    }

    /// The whole text of a kernel.
    pub(super) fn text(&self, kernel: Kernel) -> String {
        let of = |file: &'static str| {
            let replaced = self.replaced.iter().find(|(name, _)| name == file);
            let shipped = || Self::shipped(file).expect("a kernel's files are all listed");
            replaced.map_or_else(shipped, |(_, text)| text)
        };
        Self::parts(kernel).into_iter().map(of).collect::<Vec<_>>().join("\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_is_a_part_of_some_kernel_and_is_where_it_says() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/gpu");
        let read = Sources::from_folder(&folder).expect("every file is there");
        assert_eq!(read.replaced.len(), TEXTS.len());
        for (name, text) in &read.replaced {
            assert_eq!(Some(&text[..]), Sources::shipped(name));
        }
        let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let kernels = files.filter(|path| path.extension().is_some_and(|e| e == "wgsl"));
        assert_eq!(kernels.count(), TEXTS.len());
    }
}
