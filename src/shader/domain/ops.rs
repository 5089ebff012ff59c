//! Operations: how many additions and multiplications the domain shader's forms need, and how wide.
//!
//! Counted as everywhere (`unit::arithmetic`): what the form defines, and what it needs twice once.
//! A shader multiplies by 3 as by any other f32; in fixed point 3 x is the addition 2 x + x.
//!
//! The two kinds of shader differ in what they keep. `naive` reads 16 control points and forms the
//! whole product for every domain point; `basis` reads them once a patch, and in the power form
//! makes `[N][B][M]^T` once a patch. The Bernstein forms have no arithmetic that a patch could
//! share.
//!
//! ```text
//!            additions   multiplications      naive: patch + point for each domain point
//!   weights   1 (+ 2)         6 (+ 2)         basis: patch once, point for each domain point
//!   curve       12              16
//!   Horner      12              12            a domain point: weights of u and of v, 5 curves
//!   power       20 (+ 12)     (+ 12)          a patch: 8 times power, of a vec4
//! ```

use crate::config::d3d11::Form;
use rtl_model::counter::standard::Ops;

/// Bits of a single's significand.
const SIGNIFICAND: u64 = 24;
/// Bits of a parameter in U1.16.
const PARAMETER: u64 = 17;

/// The arithmetic whose operations are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Widths {
    /// Singles: 24-bit significands.
    F32,
    /// Fixed point.
    Fixed {
        /// Bits of a position.
        width: u64,
        /// Fraction bits of a weight.
        weight_bits: u64,
    },
}

impl Widths {
    /// A product by 3 of `bits` bits.
    fn thrice(self, bits: u64) -> Ops {
        match self {
            Self::F32 => Ops::default().muls(1, SIGNIFICAND, SIGNIFICAND),
            Self::Fixed { .. } => Ops::default().adds(1, bits),
        }
    }

    /// A weight: 0..=1, so one bit before the point.
    fn weight(self) -> u64 {
        match self {
            Self::F32 => SIGNIFICAND,
            Self::Fixed { weight_bits, .. } => weight_bits + 1,
        }
    }

    /// What a position has after it has grown by `more` bits.
    fn value(self, more: u64) -> u64 {
        match self {
            Self::F32 => SIGNIFICAND,
            Self::Fixed { width, .. } => width + more,
        }
    }

    /// The parameter as a factor.
    fn parameter(self) -> u64 {
        if self == Self::F32 { SIGNIFICAND } else { PARAMETER }
    }
}

/// 1 - u, the squares and cubes of both, and the two mixed products thrice.
fn weights(widths: Widths) -> Ops {
    let w = widths.weight();
    Ops::default().adds(1, PARAMETER).muls(6, w, w).with(2, widths.thrice(w))
}

/// A weighted sum of four points, x y z w.
fn curve(widths: Widths) -> Ops {
    // A row off its hull by roundings: one bit more.
    let value = widths.value(1);
    Ops::default().muls(4 * 4, widths.weight(), value).adds(4 * 3, value)
}

/// A cubic by Horner, x y z w, of coefficients that have grown by `more` bits.
fn horner(widths: Widths, more: u64) -> Ops {
    let value = widths.value(more);
    Ops::default().muls(4 * 3, value, widths.parameter()).adds(4 * 3, value)
}

/// Four points to four coefficients, x y z w: 3 P0, 3 P1, 3 P2, and 5 differences.
fn power(widths: Widths, more: u64) -> Ops {
    let value = widths.value(more);
    Ops::default().with(4 * 3, widths.thrice(value)).adds(4 * 5, value)
}

/// What a domain point costs, its patch's share left out.
#[must_use]
pub fn point(form: Form, widths: Widths) -> Ops {
    match form {
        Form::Paired | Form::Sequential => {
            Ops::default().with(2, weights(widths)).with(5, curve(widths))
        }
        // |c| <= 12 |P| a time: four bits along v, four more along u.
        Form::Power => Ops::default().with(4, horner(widths, 8)).with(1, horner(widths, 4)),
    }
}

/// What a patch costs: once in `basis`, with every domain point in `naive`.
#[must_use]
pub fn patch(form: Form, widths: Widths) -> Ops {
    match form {
        Form::Paired | Form::Sequential => Ops::default(),
        Form::Power => Ops::default().with(4, power(widths, 4)).with(4, power(widths, 8)),
    }
}

/// What a domain point costs in `naive`: the whole product.
#[must_use]
pub fn naive_point(form: Form, widths: Widths) -> Ops {
    point(form, widths).with(1, patch(form, widths))
}

#[cfg(test)]
mod tests {
    use super::super::datapath::Datapath;
    use super::super::form::{basis, coefficients, curve, rows};
    use super::*;
    use std::cell::Cell;

    /// A datapath that does nothing but count.
    #[derive(Clone, Copy)]
    struct Counting<'a>(&'a Cell<Counts>);

    #[derive(Clone, Copy, Debug, Default)]
    struct Counts {
        parameters: u64,
        products: u64,
        thrices: u64,
        scales: u64,
        triples: u64,
        sums: u64,
    }

    impl Counting<'_> {
        fn add(self, change: impl Fn(&mut Counts)) {
            let mut counts = self.0.get();
            change(&mut counts);
            self.0.set(counts);
        }
    }

    impl Datapath for Counting<'_> {
        type Weight = ();
        type Value = ();

        fn parameter(self, _: u32) {
            self.add(|c| c.parameters += 1);
        }

        fn product(self, (): (), (): ()) {
            self.add(|c| c.products += 1);
        }

        fn thrice(self, (): ()) {
            self.add(|c| c.thrices += 1);
        }

        fn scale(self, (): (), (): ()) {
            self.add(|c| c.scales += 1);
        }

        fn triple(self, (): ()) {
            self.add(|c| c.triples += 1);
        }

        fn sum(self, (): (), (): ()) {
            self.add(|c| c.sums += 1);
        }

        fn difference(self, (): (), (): ()) {
            self.add(|c| c.sums += 1);
        }
    }

    /// [additions, multiplications] of what `work` does.
    fn counted(widths: Widths, work: impl Fn(Counting<'_>)) -> [u64; 2] {
        let cell = Cell::default();
        work(Counting(&cell));
        let c: Counts = cell.get();
        // Of u and 1 - u, the second is a difference; x y z w.
        let (adds, muls) = (c.parameters / 2 + 4 * c.sums, c.products + 4 * c.scales);
        let thrices = c.thrices + 4 * c.triples;
        match widths {
            Widths::F32 => [adds, muls + thrices],
            Widths::Fixed { .. } => [adds + thrices, muls],
        }
    }

    #[test]
    fn the_operations_are_those_of_the_code() {
        for widths in [Widths::F32, Widths::Fixed { width: 32, weight_bits: 24 }] {
            for form in Form::ALL {
                let a_point = counted(widths, |d| {
                    let (u, v) = (basis(d, form, 3), basis(d, form, 5));
                    curve(d, form, &v, rows(d, form, &[(); 16], &u));
                });
                // Horner takes u as it is: of two parameters, none is a difference.
                let spare = if form == Form::Power { 1 } else { 0 };
                let got = point(form, widths);
                assert_eq!([got.add, got.mul], [a_point[0] - spare, a_point[1]], "{form:?}");
                let a_patch = counted(widths, |d| {
                    if form == Form::Power {
                        coefficients(d, &[(); 16]);
                    }
                });
                let got = patch(form, widths);
                assert_eq!([got.add, got.mul], a_patch, "{form:?}");
            }
        }
    }

    #[test]
    fn widths_are_those_of_the_formats() {
        let w = Widths::Fixed { width: 32, weight_bits: 24 };
        // Two parameters: 1 - u of 17 bits, 3 x twice of 25; 20 weighted points.
        let got = point(Form::Paired, w);
        assert_eq!([got.add, got.mul], [2 * (1 + 2) + 60, 2 * 6 + 80]);
        assert_eq!(got.add_bits, 2 * (17 + 2 * 25) + 60 * 33);
        assert_eq!(got.mul_bits, 2 * 6 * 25 * 25 + 80 * 25 * 33);
        let got = naive_point(Form::Power, Widths::F32);
        assert_eq!([got.add, got.mul], [60 + 8 * 20, 60 + 8 * 12]);
        assert_eq!([got.add_bits, got.mul_bits], [220 * 24, 156 * 24 * 24]);
    }
}
