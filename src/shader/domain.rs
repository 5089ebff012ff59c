//! The domain shader: 16 control points and a domain point (u, v) in, the point of the bicubic
//! Bezier patch out (Direct3D 11; Concheiro et al. 2014, Equations 5 to 8). Rational patches are
//! homogeneous points.
//!
//! u and v are U1.16, as the tessellator gives them: u and 1 - u are exact in both arithmetics.
//! Rows of the net first, then the curve along v:
//!
//! ```text
//!   paired      (B0 P0 + B3 P3) + (B1 P1 + B2 P2)      B0 = (w w) w   B1 = 3 (u (w w))
//!   sequential  ((B0 P0 + B1 P1) + B2 P2) + B3 P3      B3 = (u u) u   B2 = 3 (w (u u))
//!   power       ((c3 u + c2) u + c1) u + c0            c = [N][B][M]^T, w = 1 - u
//! ```
//!
//! **Paired.** Reversing an edge swaps u and w, thus B0 with B3 and B1 with B2, and the pairs keep
//! their members: only commutativity is used, so the bits are the same under any rounding. Where u
//! is 0 or 1 a weight is exactly 1 and the others are 0, so a row gives its end point, and an edge
//! is a function of its own four control points and the parameter alone, on whichever side of the
//! patch it lies. Corners are the corner points.
//!
//! **Sequential** rounds differently from either end in f32. In fixed point it gives the bits of
//! `paired`: each product is rounded, but integers are summed exactly, in any order.
//! **Power** is not symmetric in either, and where u or v is 1 even depends on the whole patch.
//! What that makes of a mesh is counted by [`Orientations`].
//!
//! Control points are finite. One that is not makes points of its patch NaN, as on a GPU.

mod datapath;
mod form;
pub mod ops;
mod orientation;

use crate::config::d3d11::Form;
use datapath::{Datapath, Integers};
use form::Basis;
use glam::Vec4;
use rtl_model::number::{Format, Modal, Overflow, OverflowMode, Rounding, RoundingMode, dispatch};
use rtl_model::patch::{ONE, Point};

pub(super) use datapath::{Datapath as Arithmetic, Singles};
pub(super) use form::{bernstein, paired};
pub use orientation::{ORIENTATIONS, Orientation, Orientations};

/// What an evaluation starts from, made once a patch: the control points, or the coefficients of
/// the power basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Net<V>([V; 16]);

/// One form in one arithmetic.
pub trait Evaluator {
    /// A coordinate of a control point or vertex.
    type Coordinate: Copy + PartialEq + std::fmt::Debug;
    /// A point or coefficient inside.
    type Value: Copy;

    /// A patch's net, from points in row-major order, u along the rows.
    fn net(&self, points: &[[Self::Coordinate; 4]; 16]) -> Net<Self::Value>;

    /// Gives `put` the point at each of `sites`, `[u, v]` in U1.16, in order, and how many of its
    /// coordinates did not fit. Sites in a row share what depends on the one parameter that they
    /// have in common: weights of v, or all of the work on the net's rows if it is u.
    ///
    /// # Panics
    /// When a parameter exceeds 1.
    fn visit(
        &self,
        net: &Net<Self::Value>,
        sites: &[[u32; 2]],
        put: &mut dyn FnMut([Self::Coordinate; 4], u32),
    );

    /// The point at one site and how many of its coordinates, 0..=4, did not fit.
    ///
    /// # Panics
    /// When a parameter exceeds 1.
    fn point(&self, net: &Net<Self::Value>, site: [u32; 2]) -> ([Self::Coordinate; 4], u32) {
        let mut point = None;
        self.visit(net, &[site], &mut |p, overflows| point = Some((p, overflows)));
        point.expect("one site has one point")
    }
}

/// Singles: plain f32 operations in a fixed order, none fused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Single {
    form: Form,
}

impl Single {
    /// An evaluator of that form.
    #[must_use]
    pub fn new(form: Form) -> Self {
        Self { form }
    }
}

impl Evaluator for Single {
    type Coordinate = f32;
    type Value = Vec4;

    fn net(&self, points: &[[f32; 4]; 16]) -> Net<Vec4> {
        net(Singles, self.form, points.map(Vec4::from_array))
    }

    fn visit(&self, net: &Net<Vec4>, sites: &[[u32; 2]], put: &mut dyn FnMut([f32; 4], u32)) {
        // A sum of zeros is -0 where all of them are, interior points' products included; + 0 makes
        // one zero of both, which is the same point.
        visit(Singles, self.form, net, sites, |p| put((p + Vec4::ZERO).to_array(), 0));
    }
}

/// Formats and policies of the fixed-point evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The position format, of control points and vertices.
    pub position: Format,
    /// Fraction bits of a weight, 16..=30. `power` has no weights but u and v.
    pub weight_bits: u32,
    /// How each product is rounded. Sums are exact.
    pub rounding: Rounding,
    /// What a vertex does that does not fit. Inside, nothing overflows: an intermediate has up to
    /// W + 8 bits and no format of its own.
    pub overflow: Overflow,
}

/// Fixed point, its format chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fixed {
    form: Form,
    settings: Settings,
    /// Fraction bits of what values are multiplied by.
    bits: u32,
    /// Whether such a product may need more than 62 bits.
    wide: bool,
}

impl Fixed {
    /// An evaluator of that form in these formats.
    ///
    /// # Panics
    /// When the weights have not 16..=30 fraction bits.
    #[must_use]
    pub fn new(form: Form, settings: Settings) -> Self {
        let Settings { position, weight_bits, .. } = settings;
        assert!(
            (16..=30).contains(&weight_bits),
            "weights of {weight_bits} fraction bits are outside 16..=30"
        );
        // Horner multiplies by u itself, whose further bits would be zeros. Its coefficients are
        // below 12 * 12 * 2^(W-1) < 2^(W+7), as are all sums on the way; a row of weighted points
        // is off the hull by a few ulps and a few 2^-bits of it.
        let (bits, product) = match form {
            Form::Power => (16, position.width + 7 + 16),
            Form::Paired | Form::Sequential => (weight_bits, position.width + weight_bits),
        };
        Self { form, settings, bits, wide: product > 61 }
    }
}

impl Evaluator for Fixed {
    type Coordinate = i64;
    type Value = Point;

    fn net(&self, points: &[Point; 16]) -> Net<Point> {
        // Nothing is multiplied but by 3: exact under every mode.
        net(Integers::<rtl_model::number::Floor, false>::new(self.bits), self.form, *points)
    }

    fn visit(&self, net: &Net<Point>, sites: &[[u32; 2]], put: &mut dyn FnMut(Point, u32)) {
        let Settings { rounding, overflow, .. } = self.settings;
        dispatch(rounding, overflow, Visit { fixed: *self, net, sites, put });
    }
}

/// A visit that wants its modes as types. Where its points go is none: the code of each mode is
/// long, and once is enough.
struct Visit<'a> {
    fixed: Fixed,
    net: &'a Net<Point>,
    sites: &'a [[u32; 2]],
    put: &'a mut dyn FnMut(Point, u32),
}

impl Modal for Visit<'_> {
    type Output = ();

    fn run<R: RoundingMode, O: OverflowMode>(self) {
        if self.fixed.wide { self.go::<R, O, true>() } else { self.go::<R, O, false>() }
    }
}

impl Visit<'_> {
    fn go<R: RoundingMode, O: OverflowMode, const WIDE: bool>(self) {
        let Self { fixed, net, sites, put } = self;
        let position = fixed.settings.position;
        visit(Integers::<R, WIDE>::new(fixed.bits), fixed.form, net, sites, |p| {
            let fitted = p.map(|c| position.fit::<O>(c));
            put(fitted.map(|(c, _)| c), fitted.map(|(_, over)| u32::from(over)).iter().sum());
        });
    }
}

fn net<D: Datapath>(d: D, form: Form, points: [D::Value; 16]) -> Net<D::Value> {
    Net(match form {
        Form::Paired | Form::Sequential => points,
        Form::Power => form::coefficients(d, &points),
    })
}

/// What the last parameters left: an inner ring walks along one and then along the other.
struct Memo<D: Datapath> {
    u: u32,
    /// The curve along v at this u.
    rows: [D::Value; 4],
    v: u32,
    basis: Basis<D>,
}

impl<D: Datapath> Memo<D> {
    #[inline(always)]
    fn point(&mut self, d: D, form: Form, net: &Net<D::Value>, [u, v]: [u32; 2]) -> D::Value {
        if u != self.u {
            assert!(u <= ONE, "a parameter of {u} / 65536 is above 1");
            (self.u, self.rows) = (u, form::rows(d, form, &net.0, &form::basis(d, form, u)));
        }
        if v != self.v {
            assert!(v <= ONE, "a parameter of {v} / 65536 is above 1");
            (self.v, self.basis) = (v, form::basis(d, form, v));
        }
        form::curve(d, form, &self.basis, self.rows)
    }
}

#[inline(always)]
fn visit<D: Datapath>(
    d: D,
    form: Form,
    net: &Net<D::Value>,
    sites: &[[u32; 2]],
    mut put: impl FnMut(D::Value),
) {
    let Some(&[u, v]) = sites.first() else { return };
    assert!(u <= ONE && v <= ONE, "a parameter of {} / 65536 is above 1", u.max(v));
    let rows = form::rows(d, form, &net.0, &form::basis(d, form, u));
    let mut memo = Memo { u, rows, v, basis: form::basis(d, form, v) };
    for &site in sites {
        put(memo.point(d, form, net, site));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn sixty_four_bits_are_enough_where_they_are_used(
            width in 2u32..=48,
            weight_bits in 16u32..=30,
            modes in (0usize..4, 0usize..2, 0usize..3),
            signs in any::<u16>(),
            extreme in any::<bool>(),
            points in proptest::array::uniform16(any::<i64>()),
            // Weights are greatest at the ends.
            site in proptest::array::uniform2(prop_oneof![0..=ONE, Just(0), Just(ONE)]),
        ) {
            let position = Format::of_range(width, 0);
            let [rounding, overflow] = [modes.0, modes.1];
            let (rounding, overflow) = (Rounding::ALL[rounding], Overflow::ALL[overflow]);
            let settings = Settings { position, weight_bits, rounding, overflow };
            let fixed = Fixed::new(Form::ALL[modes.2], settings);
            // Corners of the cube make the greatest coefficients.
            let points = std::array::from_fn(|k| {
                let sign = if signs >> k & 1 == 0 { 1 } else { -1 };
                let any = points[k] % (position.max() + 1);
                [if extreme { sign * position.max() } else { any }; 4]
            });
            let net = fixed.net(&points);
            let wide = Fixed { wide: true, ..fixed };
            prop_assert_eq!(fixed.point(&net, site), wide.point(&net, site));
        }
    }

    #[test]
    #[should_panic(expected = "weights of 31 fraction bits")]
    fn weights_whose_products_do_not_fit_are_refused() {
        let position = Format::of_range(32, 0);
        let (rounding, overflow) = (Rounding::Floor, Overflow::Wrap);
        let _ =
            Fixed::new(Form::Paired, Settings { position, weight_bits: 31, rounding, overflow });
    }

    #[test]
    #[should_panic(expected = "is above 1")]
    fn a_parameter_above_one_is_refused() {
        let single = Single::new(Form::Paired);
        let _ = single.point(&single.net(&[[0.0; 4]; 16]), [ONE + 1, 0]);
    }
}
