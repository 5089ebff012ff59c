//! Form: the three orders of operations, once for every datapath.
//!
//! All go along the rows of the net first (u), then along what comes of them (v).

use super::datapath::Datapath;
use crate::config::d3d11::Form;
use rtl_model::patch::ONE;

/// What a form needs to know of a parameter: the four Bernstein weights; or the parameter itself,
/// in the first place, for Horner.
pub(super) type Basis<D> = [<D as Datapath>::Weight; 4];

/// The basis at `t`, U1.16.
#[inline(always)]
pub(super) fn basis<D: Datapath>(d: D, form: Form, t: u32) -> Basis<D> {
    let u = d.parameter(t);
    match form {
        Form::Paired | Form::Sequential => bernstein(d, u, d.parameter(ONE - t)),
        Form::Power => [u; 4],
    }
}

/// The Bernstein polynomials from u and w = 1 - u. Swapping the two reverses them, bit for bit.
#[inline(always)]
pub(in crate::shader) fn bernstein<D: Datapath>(
    d: D,
    u: D::Weight,
    w: D::Weight,
) -> [D::Weight; 4] {
    let (uu, ww) = (d.product(u, u), d.product(w, w));
    [d.product(ww, w), d.thrice(d.product(u, ww)), d.thrice(d.product(w, uu)), d.product(uu, u)]
}

/// (B0 P0 + B3 P3) + (B1 P1 + B2 P2)
#[inline(always)]
pub(in crate::shader) fn paired<D: Datapath>(
    d: D,
    b: &[D::Weight; 4],
    p: [D::Value; 4],
) -> D::Value {
    let term = |k: usize| d.scale(b[k], p[k]);
    d.sum(d.sum(term(0), term(3)), d.sum(term(1), term(2)))
}

/// ((B0 P0 + B1 P1) + B2 P2) + B3 P3
#[inline(always)]
fn sequential<D: Datapath>(d: D, b: &[D::Weight; 4], p: [D::Value; 4]) -> D::Value {
    let term = |k: usize| d.scale(b[k], p[k]);
    d.sum(d.sum(d.sum(term(0), term(1)), term(2)), term(3))
}

/// ((c3 u + c2) u + c1) u + c0
#[inline(always)]
fn horner<D: Datapath>(d: D, u: D::Weight, [c0, c1, c2, c3]: [D::Value; 4]) -> D::Value {
    let inner = d.sum(d.scale(u, c3), c2);
    d.sum(d.scale(u, d.sum(d.scale(u, inner), c1)), c0)
}

/// The coefficients of 1, u, u^2, u^3: `[N]` of Concheiro et al. 2014, Equation 4, times four
/// points. The products by 3 and their differences serve two coefficients each.
#[inline(always)]
fn power<D: Datapath>(d: D, [p0, p1, p2, p3]: [D::Value; 4]) -> [D::Value; 4] {
    let [t0, t1, t2] = [p0, p1, p2].map(|p| d.triple(p));
    let (first, second) = (d.difference(t1, t0), d.difference(t2, t1));
    [p0, first, d.difference(second, first), d.difference(d.difference(p3, p0), second)]
}

/// `[N][B][M]^T`: u^k v^l at 4 l + k. `[N][B]` is formed first.
pub(super) fn coefficients<D: Datapath>(d: D, points: &[D::Value; 16]) -> [D::Value; 16] {
    let mut net = *points;
    for row in net.chunks_exact_mut(4) {
        row.copy_from_slice(&power(d, [row[0], row[1], row[2], row[3]]));
    }
    for k in 0..4 {
        let column = power(d, [net[k], net[4 + k], net[8 + k], net[12 + k]]);
        for (l, c) in column.into_iter().enumerate() {
            net[4 * l + k] = c;
        }
    }
    net
}

/// The control points of the curve along v, from each row of a net: they depend on u alone.
#[inline(always)]
pub(super) fn rows<D: Datapath>(
    d: D,
    form: Form,
    net: &[D::Value; 16],
    u: &Basis<D>,
) -> [D::Value; 4] {
    let row = |i: usize| curve(d, form, u, [net[i], net[i + 1], net[i + 2], net[i + 3]]);
    [row(0), row(4), row(8), row(12)]
}

/// The point of a cubic given by four control points or coefficients.
#[inline(always)]
pub(super) fn curve<D: Datapath>(d: D, form: Form, b: &Basis<D>, p: [D::Value; 4]) -> D::Value {
    match form {
        Form::Paired => paired(d, b, p),
        Form::Sequential => sequential(d, b, p),
        Form::Power => horner(d, b[0], p),
    }
}
