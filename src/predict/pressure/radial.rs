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
    /// 2π ∫ p r dr, N.
    force_n: f64,
}

/// Points of Gauss and Legendre on (−1, 1), positive half, and their weights, ten in all.
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_22, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];
/// Parts that the way across a zone is divided into for the rule of ten points.
const PARTS_PER_RADIUS: f64 = 8.0;

fn gauss(from: f64, to: f64, integrand: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let sum = GAUSS.iter().map(|&(point, weight)| {
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
            coefficients_pa,
            length_m,
            shift,
            force_n: 0.0,
        };
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

    /// ∫ p(s) s ds from 0 to `radius_m`.
    fn first_moment(&self, radius_m: f64) -> f64 {
        let radius_m = radius_m.min(self.outer_m);
        if radius_m <= self.inner_m {
            return 0.0;
        }
        // With t = shift + s/l: ∫ c t^(2i) s ds = c l² ∫ t^(2i) (t − shift) dt
        let [low, high] = [self.inner_m, radius_m].map(|s| self.shift + s / self.length_m);
        let mut exponent = 0;
        let mut sum = 0.0;
        for coefficient in &self.coefficients_pa {
            let power = |order: i32| (high.powi(order) - low.powi(order)) / f64::from(order);
            sum += coefficient * (power(exponent + 2) - self.shift * power(exponent + 1));
            exponent += 2;
        }
        sum * self.length_m.powi(2)
    }

    /// Force on a rectangle when the axis is at `centre_m`, in N.
    ///
    /// By Gauss's theorem ∫ p dA = ∮ Φ(r) dθ around the rectangle, Φ(r) = ∫₀^r p(s) s ds; exact but for the rule along the
    /// edges, which is exact to rounding.
    pub(super) fn force_on(&self, rectangle: &Rectangle, centre_m: [f64; 2]) -> f64 {
        if !rectangle.is_near_disc(centre_m, self.outer_m) {
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
        let mut ends = vec![from];
        let crossing = |radius: f64| (radius * radius - c * c).max(0.0).sqrt();
        let (inner, outer) = (crossing(self.inner_m), crossing(self.outer_m));
        ends.extend(
            [-outer, -inner, inner, outer]
                .into_iter()
                .filter(|end| (from..to).contains(end)),
        );
        ends.push(to);
        let whole = self.force_n / TAU;
        ends.windows(2)
            .map(|pair| {
                let (from, to) = (pair[0], pair[1]);
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
                    let integrand =
                        |s: f64| self.first_moment(c.hypot(s)) * c / c.mul_add(c, s * s);
                    let mut sum = 0.0;
                    let mut part = 0.0;
                    while part < parts {
                        let start = from + part * step;
                        sum += gauss(start, start + step, integrand);
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
