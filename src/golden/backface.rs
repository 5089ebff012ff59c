//! Back-face removal: a patch in, whether it shows the viewer no front out.
//!
//! The sign of det[S, Su, Sv] over x, y, w says which side of the surface the viewer is on (Loop,
//! Niessner, Eisenacher 2011). The block multiplies Bernstein forms; here S goes to the power
//! basis, the determinant is formed there as Sv . (S x Su), and only the result goes back to the
//! Bernstein basis of bidegree (8, 8). All in 256 bits: power coefficients of S have W + 6 bits,
//! the determinant 3 W + 30, its Bernstein coefficients 3 W + 44.

mod cone;
mod hull;
mod sample;

use super::{evaluate, real};
use crate::config::BackfaceMethod;
use ethnum::I256;
use rtl_model::patch::{Patch, Point, View};

pub use cone::{ROUNDING, margin};
pub use hull::holds_viewer;
pub use sample::{SAMPLES, faces_viewer, in_sight};

/// A polynomial of degree up to 8 in v (rows) and u (columns), power basis.
type Polynomial = [[I256; 9]; 9];

/// Which coordinates span the viewer's rays.
const ROWS: [usize; 3] = [0, 1, 3];

/// Whether the patch is removed; `None` where it is not tested. Of `normal_cone` without its
/// roundings: it may keep a patch whose [`margin`] is at most [`ROUNDING`].
#[must_use]
pub fn culled(patch: &Patch, view: &View, method: BackfaceMethod) -> Option<bool> {
    if !patch.cull || patch.saturated {
        return None;
    }
    let front = I256::from(if patch.reversed { -view.facing } else { view.facing });
    let faces = |volume: I256| volume * front > I256::ZERO;
    let any = match method {
        BackfaceMethod::Off => return None,
        BackfaceMethod::NetFacets => facet_volumes(&patch.points).into_iter().any(faces),
        BackfaceMethod::TangentPlane => {
            bernstein(&patch.points).as_flattened().iter().copied().any(faces)
        }
        BackfaceMethod::NormalCone => {
            margin(&patch.points, front.as_i64()).is_none_or(|margin| margin < 0.0)
        }
        BackfaceMethod::HullLiteral => !holds_viewer(&patch.points),
    };
    Some(!any)
}

/// How many facets or coefficients of a tested patch come up to the first that faces the viewer, or
/// all of them where none does; `None` where it is not tested, and for the methods whose golden
/// models look at none.
#[must_use]
pub fn looked_at(patch: &Patch, view: &View, method: BackfaceMethod) -> Option<u32> {
    if !patch.cull || patch.saturated {
        return None;
    }
    let front = I256::from(if patch.reversed { -view.facing } else { view.facing });
    let volumes = match method {
        // Of a facet's triangles, b c d comes last in the block and first here.
        BackfaceMethod::NetFacets => {
            let facets = facet_volumes(&patch.points);
            facets.chunks(4).flat_map(|t| [t[3], t[1], t[2], t[0]]).collect()
        }
        BackfaceMethod::TangentPlane => corners_first(&bernstein(&patch.points)),
        _ => return None,
    };
    let away = volumes.iter().take_while(|&&volume| volume * front <= I256::ZERO).count();
    Some(volumes.len().min(away + 1) as u32)
}

/// The coefficients row by row, but the four corners before all others.
fn corners_first(coefficients: &Polynomial) -> Vec<I256> {
    let mut places: Vec<_> = (0..81).map(|k| [k / 9, k % 9]).collect();
    places.sort_by_key(|place| place.iter().any(|k| !matches!(k, 0 | 8))); // stable
    places.into_iter().map(|[k, l]| coefficients[k][l]).collect()
}

/// Volumes under the viewer of the 36 triangles of the control net: of each facet, those that
/// leave out one corner.
fn facet_volumes(points: &[Point; 16]) -> Vec<I256> {
    let facets = [0, 1, 2, 4, 5, 6, 8, 9, 10].map(|k| [k, k + 1, k + 5, k + 4]);
    let triangles = facets
        .iter()
        .flat_map(|facet| (0..4).map(move |left_out| [1, 2, 3].map(|k| facet[(left_out + k) % 4])));
    triangles.map(|corners| leibniz(corners.map(|k| ROWS.map(|row| points[k][row])))).collect()
}

/// A 3 x 3 determinant as the sum over permutations.
fn leibniz(m: [[i64; 3]; 3]) -> I256 {
    let product =
        |[i, j, k]: [usize; 3]| I256::from(m[0][i]) * I256::from(m[1][j]) * I256::from(m[2][k]);
    let sum = |permutations: [[usize; 3]; 3]| {
        permutations.into_iter().map(product).fold(I256::ZERO, |a, b| a + b)
    };
    sum([[0, 1, 2], [1, 2, 0], [2, 0, 1]]) - sum([[2, 1, 0], [0, 2, 1], [1, 0, 2]])
}

/// The Bernstein coefficients of det[S, Su, Sv], row k along v, column l along u, times C(8,k)
/// C(8,l).
#[must_use]
pub fn bernstein(points: &[Point; 16]) -> Polynomial {
    let s = ROWS.map(|row| power(points, row));
    let (su, sv) = (s.map(|p| along_u(&p)), s.map(|p| transposed(&along_u(&transposed(&p)))));
    let zero = [[I256::ZERO; 9]; 9];
    let mut determinant = zero;
    for (i, tangent) in sv.iter().enumerate() {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let mut minor = zero; // of S and Su
        add_product(&mut minor, &s[j], &su[k], I256::ONE);
        add_product(&mut minor, &s[k], &su[j], I256::MINUS_ONE);
        add_product(&mut determinant, tangent, &minor, I256::ONE);
    }
    let rows = determinant.map(|row| to_bernstein(&row, 8));
    transposed(&transposed(&rows).map(|column| to_bernstein(&column, 8)))
}

/// S in the power basis: the i-th power's coefficient is C(3,i) times the i-th forward
/// difference, along both axes.
fn power(points: &[Point; 16], row: usize) -> Polynomial {
    let differences =
        |[a, b, c, d]: [i64; 4]| [a, 3 * (b - a), 3 * (c - 2 * b + a), d - 3 * c + 3 * b - a];
    let lines: [[i64; 4]; 4] =
        [0, 1, 2, 3].map(|i| differences([0, 1, 2, 3].map(|j| points[4 * i + j][row])));
    let mut polynomial = [[I256::ZERO; 9]; 9];
    for j in 0..4 {
        for (i, c) in differences([0, 1, 2, 3].map(|i| lines[i][j])).into_iter().enumerate() {
            polynomial[i][j] = c.into();
        }
    }
    polynomial
}

fn along_u(p: &Polynomial) -> Polynomial {
    p.map(|row| {
        std::array::from_fn(
            |j| if j < 8 { row[j + 1] * I256::new(j as i128 + 1) } else { I256::ZERO },
        )
    })
}

fn transposed(p: &Polynomial) -> Polynomial {
    std::array::from_fn(|i| std::array::from_fn(|j| p[j][i]))
}

fn add_product(sum: &mut Polynomial, a: &Polynomial, b: &Polynomial, sign: I256) {
    let terms = |p: &Polynomial| -> Vec<(usize, usize, I256)> {
        let all = (0..81).map(|k| (k / 9, k % 9, p[k / 9][k % 9]));
        all.filter(|term| term.2 != I256::ZERO).collect()
    };
    let b = terms(b);
    for (i, j, x) in terms(a) {
        for &(k, l, y) in &b {
            sum[i + k][j + l] += sign * x * y;
        }
    }
}

/// C(n,k) c_k = sum over i of C(n-i, k-i) a_i for degree n; 0 beyond it.
fn to_bernstein(a: &[I256; 9], n: usize) -> [I256; 9] {
    std::array::from_fn(|k| {
        let terms = (0..=k).filter(|_| k <= n).map(|i| a[i] * I256::new(binomial(n - i, k - i)));
        terms.fold(I256::ZERO, |x, y| x + y)
    })
}

fn binomial(n: usize, k: usize) -> i128 {
    (0..k).fold(1, |c, i| c * (n - i) as i128 / (i as i128 + 1))
}

/// det[S, Su, Sv] at (u, v), by sampling: above 0 where the front faces the viewer. 0 where f64
/// cannot tell.
#[must_use]
pub fn facing(patch: &Patch, view: &View, u: f64, v: f64) -> f64 {
    let points = real(&patch.points);
    let s = evaluate::surface(&points, u, v);
    let [su, sv] = evaluate::derivatives(&points, u, v);
    let [a, b, c] = [s, su, sv].map(|p| ROWS.map(|row| p[row]));
    let triple = |[i, j, k]: [usize; 3]| a[i] * b[j] * c[k];
    let even = [[0, 1, 2], [1, 2, 0], [2, 0, 1]].map(triple);
    let odd = [[2, 1, 0], [0, 2, 1], [1, 0, 2]].map(triple);
    let volume = even.iter().sum::<f64>() - odd.iter().sum::<f64>();
    // Coordinates are wrong by a few ulps of the largest control point, derivatives by six times
    // that.
    let largest = points.iter().flatten().fold(0f64, |m, c| m.max(c.abs()));
    let noise = 1e-13 * largest * largest * largest;
    if volume.abs() <= noise {
        return 0.0;
    }
    let front = if patch.reversed { -view.facing } else { view.facing };
    volume * front as f64
}
