//! A pressure that depends on the distance from a bolt's axis alone, and its exact force on a rectangle.

use std::f64::consts::TAU;

use super::Rectangle;

/// Pressure on the ring between two radii: a polynomial in r², zero elsewhere.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RadialPressure {
    /// Edge of the hole, m.
    inner_m: f64,
    /// Rim of the zone, m.
    outer_m: f64,
    /// p(r) = Σ_i c_i t^(2i), t = shift + r/length: Pa.
    coefficients_pa: Vec<f64>,
    length_m: f64,
    shift: f64,
    /// ∫ p r dr as a polynomial in t, and its value at the inner radius.
    moment: Vec<f64>,
    moment_at_inner: f64,
    /// 2π ∫ p r dr, N.
    force_n: f64,
}

/// Points of Gauss and Legendre on (−1, 1), positive half, and their weights: ten in all, and four.
const TEN: &[(f64, f64)] = &[
    (0.148_874_338_981_631_22, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];
const FOUR: &[(f64, f64)] = &[
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_86),
];
/// Parts that the way across a zone is divided into for the rule of ten points.
const PARTS_PER_RADIUS: f64 = 8.0;
/// Ways shorter than this part of the zone need four points only.
const SHORT: f64 = 0.02;

fn gauss(rule: &[(f64, f64)], from: f64, to: f64, integrand: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let sum = rule.iter().map(|&(point, weight)| {
        weight * (integrand(middle + half * point) + integrand(middle - half * point))
    });
    half * sum.sum::<f64>()
}

impl RadialPressure {
    /// p(r) = Σ_i c_i (shift + r/length)^(2i) for `inner_m` ≤ r ≤ `outer_m`.
    pub(super) fn new(
        [inner_m, outer_m]: [f64; 2],
        coefficients_pa: Vec<f64>,
        length_m: f64,
        shift: f64,
    ) -> Self {
        let mut radial = Self {
            inner_m,
            outer_m,
            moment: Vec::new(),
            moment_at_inner: 0.0,
            coefficients_pa,
            length_m,
            shift,
            force_n: 0.0,
        };
        radial.integrate();
        radial.force_n = TAU * radial.first_moment(outer_m);
        radial
    }

    /// One on a disc, so that "forces" are areas.
    pub(super) fn disc(radius_m: f64) -> Self {
        Self::new([0.0, radius_m], vec![1.0], 1.0, 0.0)
    }

    /// The same shape with another force.
    pub(super) fn with_force(mut self, force_n: f64) -> Self {
        let factor = match self.force_n > 0.0 {
            true => force_n / self.force_n,
            false => 0.0,
        };
        for coefficient in &mut self.coefficients_pa {
            *coefficient *= factor;
        }
        self.integrate();
        self.force_n = force_n;
        self
    }

    pub(super) fn force_n(&self) -> f64 {
        self.force_n
    }

    pub(super) fn outer_m(&self) -> f64 {
        self.outer_m
    }

    #[cfg(test)]
    fn at(&self, radius_m: f64) -> f64 {
        if !(self.inner_m..=self.outer_m).contains(&radius_m) {
            return 0.0;
        }
        let t_squared = (self.shift + radius_m / self.length_m).powi(2);
        self.coefficients_pa
            .iter()
            .rev()
            .fold(0.0, |sum, coefficient| sum * t_squared + coefficient)
    }

    /// ∫ c t^(2i) s ds = l² c (t^(2i+2)/(2i+2) − shift t^(2i+1)/(2i+1)), t = shift + s/l
    fn integrate(&mut self) {
        let square = self.length_m.powi(2);
        self.moment = vec![0.0];
        for (order, coefficient) in (0..).step_by(2).zip(&self.coefficients_pa) {
            let order = f64::from(order);
            let part = square * coefficient;
            self.moment.push(-self.shift * part / (order + 1.0));
            self.moment.push(part / (order + 2.0));
        }
        self.moment_at_inner = self.moment_at(self.inner_m);
    }

    fn moment_at(&self, radius_m: f64) -> f64 {
        let t = self.shift + radius_m / self.length_m;
        self.moment
            .iter()
            .rev()
            .fold(0.0, |sum, coefficient| sum * t + coefficient)
    }

    /// Φ(r) = ∫ p(s) s ds from 0 to `radius_m`.
    fn first_moment(&self, radius_m: f64) -> f64 {
        match radius_m > self.inner_m {
            true => self.moment_at(radius_m.min(self.outer_m)) - self.moment_at_inner,
            false => 0.0,
        }
    }

    /// Force on a rectangle when the axis is at `centre_m`, in N.
    ///
    /// By Gauss's theorem ∫ p dA = ∮ Φ(r) dθ around the rectangle, Φ(r) = ∫₀^r p(s) s ds; exact but for the rule along the
    /// edges, which is exact to rounding.
    pub(super) fn force_on(&self, rectangle: &Rectangle, centre_m: [f64; 2]) -> f64 {
        let [nearest, farthest] = rectangle.distances_m(centre_m);
        if nearest >= self.outer_m || farthest <= self.inner_m {
            return 0.0;
        }
        let [x0, x1] = rectangle.x_m().map(|x| x - centre_m[0]);
        let [y0, y1] = rectangle.y_m().map(|y| y - centre_m[1]);
        self.edge(x1, y0, y1) - self.edge(x0, y0, y1) + self.edge(y1, x0, x1)
            - self.edge(y0, x0, x1)
    }

    /// ∫ Φ(r) dθ along a straight edge at the distance `c` from the axis: dθ = c ds/(c² + s²), s from `from` to `to`.
    fn edge(&self, c: f64, from: f64, to: f64) -> f64 {
        if c == 0.0 {
            return 0.0;
        }
        let crossing = |radius: f64| (radius * radius - c * c).max(0.0).sqrt();
        let (inner, outer) = (crossing(self.inner_m), crossing(self.outer_m));
        let ends = [
            f64::NEG_INFINITY,
            -outer,
            -inner,
            inner,
            outer,
            f64::INFINITY,
        ]
        .map(|end| end.clamp(from, to));
        let whole = self.force_n / TAU;
        ends.windows(2)
            .map(|pair| {
                let (from, to) = (pair[0], pair[1]);
                if from == to {
                    return 0.0;
                }
                let middle = c.hypot(0.5 * (from + to));
                if middle >= self.outer_m {
                    whole * ((to / c).atan() - (from / c).atan())
                } else if middle <= self.inner_m {
                    0.0
                } else {
                    let parts = ((to - from) * PARTS_PER_RADIUS / self.outer_m)
                        .ceil()
                        .max(1.0);
                    let step = (to - from) / parts;
                    let rule = match step < SHORT * self.outer_m {
                        true => FOUR,
                        false => TEN,
                    };
                    let integrand =
                        |s: f64| self.first_moment(c.hypot(s)) * c / c.mul_add(c, s * s);
                    let mut sum = 0.0;
                    let mut part = 0.0;
                    while part < parts {
                        let start = from + part * step;
                        sum += gauss(rule, start, start + step, integrand);
                        part += 1.0;
                    }
                    sum
                }
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn ring() -> RadialPressure {
        RadialPressure::new([0.3, 1.1], vec![2.0, -0.9, 0.2], 0.8, 0.1)
    }

    #[test]
    fn the_cells_of_a_plate_carry_the_whole_force_wherever_the_axis_is() {
        let ring = ring();
        let quadrature: f64 = (0..4000)
            .map(|k| {
                let r = 0.3 + 0.8 * (f64::from(k) + 0.5) / 4000.0;
                TAU * ring.at(r) * r * 0.8 / 4000.0
            })
            .sum();
        assert!((ring.force_n() / quadrature - 1.0).abs() < 1e-6);
        let plate = Rectangle::new([-2.0, 3.0], [-1.5, 2.5]).unwrap();
        for (cells, centre) in [
            ([1, 1], [0.0, 0.0]),
            ([5, 4], [0.0, 0.5]),
            ([17, 23], [0.377, 0.411]),
        ] {
            let sum: f64 = plate
                .cells(cells)
                .map(|cell| ring.force_on(&cell, centre))
                .sum();
            assert!((sum / ring.force_n() - 1.0).abs() < 1e-12, "{sum}");
        }
    }

    #[test]
    fn the_force_on_a_cell_is_that_of_fine_quadrature() {
        let ring = ring();
        let cell = Rectangle::new([0.2, 0.9], [-0.1, 0.6]).unwrap();
        let count = 1500;
        let sum: f64 = cell
            .cells([count, count])
            .map(|part| {
                let [x, y] = part.centre_m();
                ring.at(x.hypot(y)) * part.area_m2()
            })
            .sum();
        assert!((ring.force_on(&cell, [0.0, 0.0]) / sum - 1.0).abs() < 2e-4);
    }

    #[test]
    fn there_is_no_force_beyond_the_rim_or_within_the_hole() {
        let ring = ring();
        for ([x_m, y_m], touches) in [
            ([[0.7, 0.8], [0.9, 1.0]], false),
            ([[0.7, 0.8], [0.8, 0.9]], true),
            ([[-0.2, 0.2], [-0.2, 0.2]], false),
            ([[-0.2, 0.2], [-0.2, 0.25]], true),
        ] {
            let cell = Rectangle::new(x_m, y_m).unwrap();
            let force_n = ring.force_on(&cell, [0.0, 0.0]);
            assert!(if touches {
                force_n > 1e-6
            } else {
                force_n == 0.0
            });
        }
    }

    #[test]
    fn areas_of_discs_and_rectangles() {
        let disc = RadialPressure::disc(0.5);
        assert!((disc.force_n() - PI / 4.0).abs() < 1e-15);
        let quadrant = Rectangle::new([0.0, 1.0], [0.0, 1.0]).unwrap();
        assert!((disc.force_on(&quadrant, [0.0, 0.0]) - PI / 16.0).abs() < 1e-14);
        let inside = Rectangle::new([-0.1, 0.2], [0.05, 0.1]).unwrap();
        assert!((disc.force_on(&inside, [0.0, 0.0]) - 0.015).abs() < 1e-15);
        // Segment of height 0.2: r² acos(1 − h/r) − (r − h)√(2rh − h²)
        let beyond = Rectangle::new([0.3, 2.0], [-2.0, 2.0]).unwrap();
        let segment = 0.25 * (0.6_f64).acos() - 0.3 * 0.16_f64.sqrt();
        assert!((disc.force_on(&beyond, [0.0, 0.0]) - segment).abs() < 1e-12);
    }
}
