//! Control-point shader and port: the points of a batch in, quantised on all threads.

use super::Batch;
use crate::config::{Config, Unit};
use crate::shader::control_point;
use crate::unit::frame::FrameState;
use glam::Mat4;
use rayon::prelude::*;
use rtl_model::counter::{Counter, Counters};
use rtl_model::number::{Format, Modal, OverflowMode, RoundingMode, dispatch};
use rtl_model::port::{self, Quantised};

/// Points in a piece of work, at most: a span may have all points of a large draw.
const POINT_GRAIN: usize = 512;

/// Pieces of points that a thread takes at a time, at least: a span may have a line of a mesh only.
const WORK_GRAIN: usize = 4;

impl Batch {
    /// Control-point shader and port, on all threads.
    pub(super) fn quantise(
        &mut self,
        config: &Config,
        frame: &FrameState,
        counters: &mut Counters,
    ) {
        if config.unit == Unit::D3d11 {
            self.shade();
        }
        let mut quantised = std::mem::take(&mut self.quantised);
        let [points, overflows, saturated] = if config.unit.in_object_space() {
            let mut seen = std::mem::take(&mut self.seen);
            self.port(config, frame.view.position, true, &mut seen);
            self.seen = seen;
            self.port(config, frame.object, false, &mut quantised)
        } else {
            self.port(config, frame.view.position, true, &mut quantised)
        };
        self.quantised = quantised;
        if config.unit == Unit::Esc && config.esc.tests_in_object_space() {
            let mut object = std::mem::take(&mut self.object);
            let [.., saturated] = self.port(config, frame.object, false, &mut object);
            self.object = object;
            counters.add(Counter::PortObjectSaturated, saturated);
        }
        counters.add(Counter::PortPoints, points);
        counters.add(Counter::PortOverflows, overflows);
        counters.add(Counter::PortSaturated, saturated);
    }

    /// All points in clip space, in f32.
    fn shade(&mut self) {
        let Self { points, spans, clip, .. } = self;
        clip.clear();
        for span in spans {
            let points = &points[span.points.clone()];
            let shaded = points.par_iter().with_min_len(POINT_GRAIN);
            clip.par_extend(shaded.map(|&p| control_point::transform(&span.clip_from_object, p)));
        }
    }

    /// Quantises all points, transformed or as they are. Returns points received, coordinates that
    /// did not fit, points with such a coordinate.
    fn port(
        &self,
        config: &Config,
        format: Format,
        transformed: bool,
        out: &mut Vec<Quantised>,
    ) -> [u64; 3] {
        out.resize(self.shaded, Quantised { point: [0; 4], overflows: 0 });
        let mut rest = &mut out[..];
        let mut works = Vec::with_capacity(self.spans.len());
        for span in &self.spans {
            let (out, after) = rest.split_at_mut(span.points.len());
            rest = after;
            let pieces = self.points[span.points.clone()].chunks(POINT_GRAIN);
            for (k, (points, out)) in pieces.zip(out.chunks_mut(POINT_GRAIN)).enumerate() {
                let repeated = span.repeated.saturating_sub(k * POINT_GRAIN).min(out.len());
                let matrix = transformed.then_some(&span.clip_from_object);
                works.push(PortWork { matrix, points, repeated, format, out });
            }
        }
        let (rounding, overflow) = (config.position.rounding, config.position.overflow);
        let port = |work| dispatch(rounding, overflow, work);
        let counts = works.into_par_iter().with_min_len(WORK_GRAIN).map(port);
        counts.reduce(|| [0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]])
    }
}

struct PortWork<'a> {
    /// What the control-point shader transforms with; `None` where there is none.
    matrix: Option<&'a Mat4>,
    points: &'a [[f32; 4]],
    /// How many of the first points were received, and counted, before.
    repeated: usize,
    format: Format,
    out: &'a mut [Quantised],
}

impl Modal for PortWork<'_> {
    /// Points received, coordinates that did not fit, points with such a coordinate.
    type Output = [u64; 3];

    fn run<R: RoundingMode, O: OverflowMode>(self) -> [u64; 3] {
        for (out, &point) in self.out.iter_mut().zip(self.points) {
            let point = self.matrix.map_or(point, |m| control_point::transform(m, point));
            *out = port::accept::<R, O>(point.map(f32::to_bits), self.format);
        }
        let received = &self.out[self.repeated..];
        let overflows = received.iter().map(|q| u64::from(q.overflows)).sum();
        let saturated = received.iter().filter(|q| q.overflows > 0).count();
        [received.len() as u64, overflows, saturated as u64]
    }
}
