//! Shape: processed factors and a patch in; its vertices and triangles out, and what the
//! tessellator, the cache of shaded points and the domain shader did for them.

use super::count_bursts;
use crate::config::{Arithmetic, Config, DomainKind, Normals};
use crate::shader::domain::{Evaluator, Fixed, Orientations, Settings, Single};
use crate::unit::chain::Pattern;
use crate::unit::frame::FrameState;
use crate::unit::pipeline::Input;
use rtl_model::counter::{Block, Counter, Counters};
use rtl_model::d3d11::wave::Waves;
use rtl_model::d3d11::{Factors, Output, Tessellator};
use rtl_model::number::{Format, Modal, OverflowMode, RoundingMode, dispatch};
use rtl_model::patch::{ONE, Point, Triangle, Vertex};
use rtl_model::port;
use rtl_model::stitch::degenerate;

/// Bytes of a patch's control points: 16 vec4.
const NET_BYTES: u64 = 16 * 16;

/// The blocks behind the hull shader.
pub(super) struct Shape {
    config: Config,
    position: Format,
    tessellator: Tessellator,
    /// What the tessellator made last, and how many of its triangles are turned round or without
    /// area, and of its points not monotone.
    last: Option<(Factors, Quirks)>,
    waves: Waves,
    evaluate: Evaluate,
    /// Cycles of a wave.
    interval: u64,
}

enum Evaluate {
    F32(Single),
    Fixed(Fixed),
}

impl Shape {
    pub(super) fn new(config: &Config, frame: &FrameState) -> Self {
        let (domain, position) = (&config.domain, frame.position(config));
        let settings = Settings {
            position,
            weight_bits: domain.weight_bits,
            rounding: config.evaluate.rounding,
            overflow: config.position.overflow,
        };
        let costs = config.costs(Block::Domain).expect("the domain shader has costs");
        Self {
            config: config.clone(),
            position,
            tessellator: Tessellator::default(),
            last: None,
            waves: Waves::new(domain.cache_entries, domain.width as u16),
            evaluate: match domain.arithmetic {
                Arithmetic::F32 => Evaluate::F32(Single::new(config.form())),
                Arithmetic::Fixed => Evaluate::Fixed(Fixed::new(config.form(), settings)),
            },
            interval: costs.interval.into(),
        }
    }

    pub(super) fn triangles(&self) -> &[Triangle] {
        self.tessellator.indices().as_chunks().0
    }

    /// Makes a patch. Returns the points that were shaded.
    pub(super) fn accept(
        &mut self,
        pattern: &Pattern,
        input: &Input<'_>,
        vertices: &mut Vec<Vertex>,
        counters: &mut Counters,
    ) -> u64 {
        let quirks = self.tessellate(&pattern.factors);
        let overflows = self.evaluate(input, vertices);
        let Self { tessellator, waves, .. } = self;
        let (triangles, _) = tessellator.indices().as_chunks();
        let mut count = 0;
        let shaded = waves.walk(triangles, |_| count += 1);
        counters.add(Counter::PointsGenerated, vertices.len() as u64);
        counters.add(Counter::PointsParameters, quirks.parameters);
        counters.add(Counter::PointsNonMonotone, quirks.non_monotone);
        counters.add(Counter::ConnectTriangles, triangles.len() as u64);
        counters.add(Counter::ConnectInverted, quirks.inverted);
        counters.add(Counter::ConnectZeroArea, quirks.zero_area);
        counters.add(Counter::ConnectDegenerate, degenerate(vertices, triangles));
        counters.add(Counter::DomainRepeated, shaded - vertices.len() as u64);
        counters.add(Counter::DomainOverflows, overflows);
        counters.add(Counter::DomainCracks, self.cracks(input));
        self.count(shaded, count, pattern, input.components, counters);
        shaded
    }

    fn tessellate(&mut self, factors: &Factors) -> Quirks {
        match self.last {
            Some((last, quirks)) if last == *factors => quirks,
            _ => {
                self.tessellator.accept(factors, Output::Cw);
                let quirks = Quirks::of(factors, self.tessellator.points(), self.triangles());
                self.last = Some((*factors, quirks));
                quirks
            }
        }
    }

    /// The vertices. Returns the coordinates that did not fit.
    fn evaluate(&self, input: &Input<'_>, vertices: &mut Vec<Vertex>) -> u64 {
        let sites = self.tessellator.points();
        vertices.clear();
        vertices.reserve(sites.len());
        let mut overflows = 0;
        match &self.evaluate {
            Evaluate::F32(single) => {
                let net = single.net(input.shaded);
                let (rounding, overflow) =
                    (self.config.position.rounding, self.config.position.overflow);
                let format = self.position;
                let run = Singles { single, net: &net, sites, format, vertices };
                overflows = dispatch(rounding, overflow, run);
            }
            Evaluate::Fixed(fixed) => {
                let net = fixed.net(&input.patch.points);
                let mut rest = sites.iter();
                fixed.visit(&net, sites, &mut |position, over| {
                    let &[u, v] = rest.next().expect("a point a site");
                    vertices.push(Vertex { position, u, v });
                    overflows += u64::from(over);
                });
            }
        }
        overflows
    }

    /// Boundary points, corners left out, that a neighbour may get otherwise.
    fn cracks(&self, input: &Input<'_>) -> u64 {
        if self.config.is_order_invariant() {
            return 0;
        }
        let sites = self.tessellator.points().iter();
        let end = |t: u32| t == 0 || t == ONE;
        let mut boundary = sites.filter(|[u, v]| end(*u) != end(*v));
        let count: usize = match &self.evaluate {
            Evaluate::F32(single) => {
                let turned = Orientations::new(single, input.shaded);
                boundary.by_ref().filter(|&&site| turned.crack(site)).count()
            }
            Evaluate::Fixed(fixed) => {
                let turned = Orientations::new(fixed, &input.patch.points);
                boundary.by_ref().filter(|&&site| turned.crack(site)).count()
            }
        };
        count as u64
    }

    /// What the domain shader moves, for so many invocations in so many waves.
    fn count(
        &self,
        shaded: u64,
        waves: u64,
        pattern: &Pattern,
        components: u64,
        counters: &mut Counters,
    ) {
        let Config { domain, attributes, .. } = &self.config;
        let idle = waves * u64::from(domain.width) - shaded;
        let nets = match domain.shader {
            DomainKind::Naive => shaded,
            DomainKind::Basis => 1,
        };
        let corner = components * attributes.component_bytes();
        counters.add(Counter::DomainInvocations, shaded);
        counters.add(Counter::DomainWaves, waves);
        counters.add(Counter::DomainIdle, idle);
        counters.add(Counter::DomainIdleCycles, idle * self.interval);
        counters.add(Counter::DomainBytesControlPoints, nets * NET_BYTES);
        counters.add(Counter::DomainBytesParameters, shaded * u64::from(domain.bytes_in));
        counters.add(Counter::DomainBytesAttributes, nets * 4 * corner);
        counters.add(Counter::DomainBytesOut, shaded * (u64::from(domain.bytes_out) + corner));
        counters.add(Counter::DomainAttributes, shaded * components);
        if self.config.evaluate.normals == Normals::TangentPlane {
            counters.add(Counter::DomainNormals, shaded);
        }
        if self.config.hull.to_memory {
            let bytes = u64::from(pattern.hull_bytes);
            counters.add(Counter::MemoryReadPatches, bytes);
            count_bursts(1, bytes, &self.config, counters);
        }
    }
}

/// Vertices in f32, each rounded to the position format when it is done.
struct Singles<'a> {
    single: &'a Single,
    net: &'a crate::shader::domain::Net<glam::Vec4>,
    sites: &'a [[u32; 2]],
    format: Format,
    vertices: &'a mut Vec<Vertex>,
}

impl Modal for Singles<'_> {
    /// Coordinates that did not fit.
    type Output = u64;

    fn run<R: RoundingMode, O: OverflowMode>(self) -> u64 {
        let Self { single, net, sites, format, vertices } = self;
        let mut overflows = 0;
        let mut rest = sites.iter();
        single.visit(net, sites, &mut |point, _| {
            let &[u, v] = rest.next().expect("a point a site");
            let quantised = port::accept::<R, O>(point.map(f32::to_bits), format);
            let position: Point = quantised.point;
            vertices.push(Vertex { position, u, v });
            overflows += u64::from(quantised.overflows);
        });
        overflows
    }
}

/// What a pattern took, and what it has that nobody asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Quirks {
    /// Parameters placed.
    parameters: u64,
    /// Points of edges that lie before the point before them.
    non_monotone: u64,
    /// Triangles turned round in the domain.
    inverted: u64,
    /// Triangles without area there.
    zero_area: u64,
}

impl Quirks {
    fn of(factors: &Factors, points: &[[u32; 2]], triangles: &[Triangle]) -> Self {
        let at = |k: u16| points[usize::from(k)].map(i64::from);
        let (mut inverted, mut zero_area) = (0, 0);
        for &[a, b, c] in triangles {
            let ([ax, ay], [bx, by], [cx, cy]) = (at(a), at(b), at(c));
            let area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
            inverted += u64::from(area < 0);
            zero_area += u64::from(area == 0);
        }
        let edges = (0..4).map(|edge| factors.edge_points(edge)).sum::<usize>();
        let inner = factors.inner_points(0) + factors.inner_points(1);
        let parameters = (edges + inner) as u64;
        Self { parameters, non_monotone: non_monotone(factors, points), inverted, zero_area }
    }
}

/// Of the outer ring, which begins at (0, 1): down U = 0, then V = 0, U = 1, V = 1.
fn non_monotone(factors: &Factors, points: &[[u32; 2]]) -> u64 {
    let lengths = [0, 1, 2, 3].map(|edge| factors.edge_points(edge) - 1);
    let ring = &points[..lengths.iter().sum()];
    let mut first = 0;
    let mut count = 0;
    for (edge, length) in lengths.into_iter().enumerate() {
        let along = |k: usize| ring[(first + k) % ring.len()][1 - edge % 2];
        let forward = edge == 1 || edge == 2;
        let turned = |k: &usize| {
            if forward { along(*k) > along(k + 1) } else { along(*k) < along(k + 1) }
        };
        count += (0..length).filter(turned).count() as u64;
        first += length;
    }
    count
}
