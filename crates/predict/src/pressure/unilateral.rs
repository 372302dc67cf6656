//! What an external force and moment do to a field whose parts press but do not pull.

use nalgebra::{Matrix3, Vector3};

use super::uniform::check_force;
use super::{Element, PressureError, PressureField};
use crate::number::check;

/// A field that carries a given force and moment, opened where it would have to pull.
#[derive(Debug, Clone, PartialEq)]
pub struct UnilateralField {
    /// The pressure.
    pub field: PressureField,
    /// Area that was in contact before and is open now, in m².
    pub opened_area_m2: f64,
}

/// Newton steps at most; a resultant that contact can carry needs about ten.
const STEPS: usize = 200;
/// Force and moments that are left over, part of the force and of the force times the size of the area.
const RESIDUAL: f64 = 1e-13;
/// With this much left over after all steps, rounding is the reason.
const ACCEPTABLE: f64 = 1e-9;

impl PressureField {
    /// The field when the interface as a whole carries `force_n` (N) and `moments_n_m` about the x and the y axis (N·m), as
    /// [`PressureField::moments_n_m`] counts them.
    ///
    /// Parts that stay flat change the pressure linearly: p = max(0, p₀ + a + b x + c y) where p₀, this field, is above zero.
    /// Where it is zero the parts have a gap, which stays open. a, b and c follow from the three balances; there is one
    /// solution, the minimum of a convex function.
    ///
    /// # Errors
    /// [`PressureError::Number`] for loads that are not finite, [`PressureError::Opens`] if no pressure without tension on the area in contact has
    /// this resultant.
    pub fn carrying(
        &self,
        force_n: f64,
        moments_n_m: [f64; 2],
    ) -> Result<UnilateralField, PressureError> {
        check_force(force_n)?;
        for moment in moments_n_m {
            let expected = "a finite number";
            check(
                moment.is_finite(),
                "the moment in N·m",
                moment,
                "",
                expected,
            )?;
        }
        let opens = || PressureError::Opens {
            force_n,
            moments_n_m,
        };
        let contact = Contact::new(self).ok_or_else(opens)?;
        let plane = contact.balance(force_n, moments_n_m).ok_or_else(opens)?;
        let mut opened_area_m2 = 0.0;
        let elements = self.elements().iter().map(|element| {
            if element.pressure_pa == 0.0 {
                return *element;
            }
            let pressure_pa = (element.pressure_pa + plane.dot(&contact.basis(element))).max(0.0);
            if pressure_pa == 0.0 {
                opened_area_m2 += element.area_m2;
            }
            Element {
                pressure_pa,
                ..*element
            }
        });
        Ok(UnilateralField {
            field: Self::new(elements.collect())?,
            opened_area_m2,
        })
    }
}

/// The elements in contact, and coordinates in which they spread about one to each side of zero.
struct Contact<'a> {
    field: &'a PressureField,
    centre_m: [f64; 2],
    size_m: f64,
}

impl<'a> Contact<'a> {
    /// `None` if nothing touches.
    fn new(field: &'a PressureField) -> Option<Self> {
        let touching = || field.elements().iter().filter(|e| e.pressure_pa > 0.0);
        let area: f64 = touching().map(|e| e.area_m2).sum();
        let mean = |value: fn(&Element) -> f64| {
            touching().map(|e| e.area_m2 * value(e)).sum::<f64>() / area
        };
        let centre_m = [mean(|e| e.x_m), mean(|e| e.y_m)];
        let size_m = touching()
            .map(|e| (e.x_m - centre_m[0]).hypot(e.y_m - centre_m[1]))
            .fold(0.0, f64::max);
        // A single element has no lever arm, but can carry a force.
        let size_m = match size_m > 0.0 {
            true => size_m,
            false => area.sqrt(),
        };
        (area > 0.0).then_some(Self {
            field,
            centre_m,
            size_m,
        })
    }

    /// 1, ξ and η of an element: its place from the centre over the size.
    fn basis(&self, element: &Element) -> Vector3<f64> {
        Vector3::new(
            1.0,
            (element.x_m - self.centre_m[0]) / self.size_m,
            (element.y_m - self.centre_m[1]) / self.size_m,
        )
    }

    /// The plane a + b ξ + c η (Pa) that is added to the field.
    fn balance(&self, force_n: f64, [about_x, about_y]: [f64; 2]) -> Option<Vector3<f64>> {
        // ∫ p dA = N, ∫ p ξ dA = (−M_y − N x₀)/L, ∫ p η dA = (M_x − N y₀)/L
        let target = Vector3::new(
            force_n,
            (-about_y - force_n * self.centre_m[0]) / self.size_m,
            (about_x - force_n * self.centre_m[1]) / self.size_m,
        );
        let scale_n = force_n + self.field.force_n();
        let mut plane = Vector3::zeros();
        let mut state = self.state(&plane, &target);
        for _ in 0..STEPS {
            bolted_joint_wanted::look();
            if state.residual.amax() <= RESIDUAL * scale_n {
                return Some(plane);
            }
            // Elements that are open count a little, so that the step exists when too few are closed.
            let hessian = state.closed + self.all() * 1e-10;
            let step = hessian.cholesky()?.solve(&-state.residual);
            let slope = step.dot(&state.residual);
            let mut length = 1.0;
            let next = loop {
                let plane = plane + step * length;
                let next = self.state(&plane, &target);
                // At rounding the function no longer falls, but the balance may still improve.
                let falls = next.potential <= state.potential + 1e-4 * length * slope
                    || next.residual.amax() < 0.5 * state.residual.amax();
                if falls {
                    break Some((plane, next));
                }
                length *= 0.5;
                if length < 1e-12 {
                    break None;
                }
            };
            match next {
                Some((better, next)) => {
                    plane = better;
                    state = next;
                }
                None => break,
            }
        }
        (state.residual.amax() <= ACCEPTABLE * scale_n).then_some(plane)
    }

    /// Φ = Σ ½ max(0, p)² ΔA − target · plane, its gradient and its Hessian.
    fn state(&self, plane: &Vector3<f64>, target: &Vector3<f64>) -> State {
        let mut state = State {
            potential: -plane.dot(target),
            residual: -target,
            closed: Matrix3::zeros(),
        };
        for element in self.field.elements() {
            if element.pressure_pa == 0.0 {
                continue;
            }
            let basis = self.basis(element);
            let pressure = element.pressure_pa + plane.dot(&basis);
            if pressure > 0.0 {
                state.potential += 0.5 * pressure * pressure * element.area_m2;
                state.residual += basis * (pressure * element.area_m2);
                state.closed += basis * basis.transpose() * element.area_m2;
            }
        }
        state
    }

    fn all(&self) -> Matrix3<f64> {
        let touching = self.field.elements().iter().filter(|e| e.pressure_pa > 0.0);
        let area_m2: f64 = touching.map(|element| element.area_m2).sum();
        Matrix3::identity() * area_m2
    }
}

struct State {
    potential: f64,
    residual: Vector3<f64>,
    closed: Matrix3<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pressure::Rectangle;

    #[test]
    fn beyond_the_kern_the_pressure_is_a_triangle() {
        // N at the distance c from the edge of a rectangle of breadth b: the triangle is 3c long, and its peak 2N/(3 b c).
        let (height, breadth) = (0.4, 0.1);
        let outline = Rectangle::centred(height, breadth).unwrap();
        let even = PressureField::uniform(&outline, [4000, 1], 1000.0).unwrap();
        let eccentricity = 0.12;
        let (force_n, c) = (5000.0, 0.5 * height - eccentricity);
        let found = even
            .carrying(force_n, [0.0, -force_n * eccentricity])
            .unwrap();
        let field = found.field;
        assert!((field.force_n() / force_n - 1.0).abs() < 1e-12);
        assert!((field.moments_n_m()[1] / (-force_n * eccentricity) - 1.0).abs() < 1e-12);
        let peak_pa = field.elements().last().unwrap().pressure_pa;
        assert!((peak_pa / (2.0 * force_n / (3.0 * breadth * c)) - 1.0).abs() < 5e-4);
        let open = (height - 3.0 * c) * breadth;
        assert!((found.opened_area_m2 / open - 1.0).abs() < 2e-3);
    }

    #[test]
    fn within_the_kern_it_is_the_beam_formula() {
        let outline = Rectangle::new([0.0, 0.3], [0.1, 0.3]).unwrap();
        let field = PressureField::uniform(&outline, [30, 20], 900.0).unwrap();
        // p = N/A (1 ± 6e/h) with the moments about the origin of a force at (0.16, 0.19)
        let found = field
            .carrying(3000.0, [3000.0 * 0.19, -3000.0 * 0.16])
            .unwrap();
        assert_eq!(found.opened_area_m2, 0.0);
        // Cells take the moment of their middles: the second moment is that of 30 and of 20 cells.
        let mean = 3000.0 / 0.06;
        let second = |length: f64, cells: f64| length.powi(2) * (1.0 - cells.powi(-2)) / 12.0;
        for element in found.field.elements() {
            let expected = mean
                * (1.0 + 0.01 * (element.x_m - 0.15) / second(0.3, 30.0)
                    - 0.01 * (element.y_m - 0.2) / second(0.2, 20.0));
            assert!((element.pressure_pa / expected - 1.0).abs() < 1e-11);
        }
    }

    #[test]
    fn a_force_outside_the_area_opens_the_joint() {
        let outline = Rectangle::centred(0.2, 0.2).unwrap();
        let field = PressureField::uniform(&outline, [20, 20], 900.0).unwrap();
        let error = field.carrying(100.0, [0.0, -100.0 * 0.11]).unwrap_err();
        assert!(matches!(error, PressureError::Opens { .. }));
        assert!(error.to_string().contains("x = 0.11 m"), "{error}");
    }
}
