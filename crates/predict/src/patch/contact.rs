//! What an element of the contact has per area, and the sums over the interface that a joint needs of it.

use crate::pressure::Element;

/// Stiffness and hysteretic damping of the contact per area, normal to the interface and along it, N/m³.
///
/// A hysteretic damping d per area dissipates π d X² per area and cycle of amplitude X, at every frequency.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Contact {
    /// k_n.
    pub normal_stiffness_n_per_m3: f64,
    /// k_t.
    pub tangential_stiffness_n_per_m3: f64,
    /// d_n = η_n k_n.
    pub normal_damping_n_per_m3: f64,
    /// d_t = η_t k_t.
    pub tangential_damping_n_per_m3: f64,
}

impl Contact {
    /// What it has along the normal alone.
    pub(crate) fn along_normal(self) -> Self {
        Self {
            tangential_stiffness_n_per_m3: 0.0,
            tangential_damping_n_per_m3: 0.0,
            ..self
        }
    }
}

/// Σ s ΔA, Σ s r_x ΔA, … Σ s r_y² ΔA of a density s, with lever arms r from a reference point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PatchMoments {
    /// Σ s ΔA.
    pub sum: f64,
    /// Σ s r_x ΔA and Σ s r_y ΔA.
    pub first: [f64; 2],
    /// Σ s r_x² ΔA, Σ s r_x r_y ΔA and Σ s r_y² ΔA.
    pub second: [f64; 3],
}

impl PatchMoments {
    /// Adds an element: density times area, and its lever arms.
    #[inline]
    pub fn add(&mut self, weight: f64, [x_m, y_m]: [f64; 2]) {
        let (by_x, by_y) = (weight * x_m, weight * y_m);
        self.sum += weight;
        self.first[0] += by_x;
        self.first[1] += by_y;
        self.second[0] += by_x * x_m;
        self.second[1] += by_x * y_m;
        self.second[2] += by_y * y_m;
    }
}

/// The moments of each of the four densities of [`Contact`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct ContactMoments {
    pub(super) normal_stiffness: PatchMoments,
    pub(super) tangential_stiffness: PatchMoments,
    pub(super) normal_damping: PatchMoments,
    pub(super) tangential_damping: PatchMoments,
}

impl ContactMoments {
    /// Over all elements, with lever arms from the point `about`.
    pub(super) fn of<'e>(
        parts: impl Iterator<Item = (&'e Element, Contact)>,
        about: [f64; 3],
    ) -> Self {
        let mut moments = Self::default();
        for (element, contact) in parts {
            let arms = [element.x_m - about[0], element.y_m - about[1]];
            let area = element.area_m2;
            for (moments, per_area) in [
                (
                    &mut moments.normal_stiffness,
                    contact.normal_stiffness_n_per_m3,
                ),
                (
                    &mut moments.tangential_stiffness,
                    contact.tangential_stiffness_n_per_m3,
                ),
                (&mut moments.normal_damping, contact.normal_damping_n_per_m3),
                (
                    &mut moments.tangential_damping,
                    contact.tangential_damping_n_per_m3,
                ),
            ] {
                moments.add(per_area * area, arms);
            }
        }
        moments
    }
}
