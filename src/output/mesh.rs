//! The mesh of one frame, in the form that was asked for: a [`Sink`] that wants that frame and no
//! other.

use super::file::AtomicFile;
use super::obj::Obj;
use super::ply::Ply;
use super::svg::Svg;
use crate::config::Config;
use crate::error::{Error, Result};
use crate::report::no_such_frame;
use crate::sink::{FrameInfo, PatchMesh, Sink};
use std::path::Path;

/// Forms of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshForm {
    /// Exact, for programs.
    Ply,
    /// For other programs.
    Obj,
    /// A wireframe of the projected frame, for people.
    Svg,
}

impl MeshForm {
    /// The name of its file in a result folder.
    #[must_use]
    pub const fn file_name(self) -> &'static str {
        match self {
            Self::Ply => "mesh.ply",
            Self::Obj => "mesh.obj",
            Self::Svg => "mesh.svg",
        }
    }
}

/// A mesh file under construction.
#[derive(Debug)]
pub struct MeshFile {
    number: u64,
    frame: Option<FrameInfo>,
    form: Form,
}

#[derive(Debug)]
enum Form {
    Ply(Ply),
    Obj(Obj),
    Svg(Svg),
}

impl MeshFile {
    /// Begins the mesh of frame `number` in `folder`.
    ///
    /// # Errors
    /// [`Error::Usage`] when the configuration makes nothing to draw, [`Error::System`] when it
    /// cannot be written there.
    pub fn create(
        form: MeshForm,
        folder: &Path,
        number: u64,
        title: &str,
        config: &Config,
    ) -> Result<Self> {
        if form == MeshForm::Svg && !config.divides() {
            let reason = if config.unit.in_object_space() {
                "a unit before transform has not"
            } else {
                "`emit.divide = false` leaves out"
            };
            return Err(Error::Usage(format!("--mesh svg draws screen positions, which {reason}")));
        }
        let out = AtomicFile::create(folder.join(form.file_name()))?;
        let form = match form {
            MeshForm::Ply => Form::Ply(Ply::create(out, &config.attributes)?),
            MeshForm::Obj => Form::Obj(Obj::create(out)?),
            MeshForm::Svg => Form::Svg(Svg::create(out, title, config.emit.subpixel_bits)?),
        };
        Ok(Self { number, frame: None, form })
    }

    /// Completes the file.
    ///
    /// # Errors
    /// [`Error::Usage`] when the frame never came, [`Error::System`] when the file cannot be
    /// written.
    pub fn finish(self, frames: usize) -> Result<()> {
        if self.frame.is_none() {
            return Err(no_such_frame(self.number, frames));
        }
        match self.form {
            Form::Ply(ply) => ply.finish(),
            Form::Obj(obj) => obj.finish(),
            Form::Svg(svg) => svg.finish(),
        }
    }
}

impl Sink for MeshFile {
    fn wants(&self, frame: u64) -> bool {
        frame == self.number
    }

    fn frame(&mut self, frame: &FrameInfo) -> Result<()> {
        self.frame = Some(*frame);
        if let Form::Svg(svg) = &mut self.form {
            svg.frame(frame);
        }
        Ok(())
    }

    fn patch(&mut self, mesh: &PatchMesh<'_>) -> Result<()> {
        let frame = self.frame.as_ref().expect("a frame begins before its patches");
        match &mut self.form {
            Form::Ply(ply) => ply.patch(frame, mesh),
            Form::Obj(obj) => obj.patch(frame, mesh),
            Form::Svg(svg) => svg.patch(frame, mesh),
        }
    }
}
