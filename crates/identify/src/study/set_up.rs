//! What a study states of a structure's set-up: masses that it knows, and how well it knows single values.

use std::collections::BTreeMap;

use bolted_joint_frf::Dof;

/// What is known of a structure beside its receptances.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SetUp {
    /// What only the assembly has at each bolt on this structure, such as half of the bolt.
    pub masses: Vec<MassAtJoint>,
    /// Standard deviations that the study states of single values.
    pub deviations: Deviations,
}

/// A rigid mass at the joint on one structure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MassAtJoint {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Moment of inertia about the axis of the joint's rotation, kg·m².
    pub inertia_kg_m2: f64,
}

/// Standard deviations that stand beside the values they belong to. They hold over those of the budget.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deviations {
    /// Young's modulus of a beam, relative.
    pub youngs_modulus: Option<f64>,
    /// Density of a beam, relative.
    pub density: Option<f64>,
    /// Bending stiffness that the correction of rotations by differences is made with, relative.
    pub difference_stiffness: Option<f64>,
    /// Position of the joint at each bolt, m.
    pub joints_m: Vec<Option<f64>>,
    /// Positions of points, m.
    pub points_m: BTreeMap<Dof, f64>,
    /// Mass at the joint at each bolt, kg.
    pub masses_kg: Vec<Option<f64>>,
    /// Moment of inertia at the joint at each bolt, kg·m².
    pub inertias_kg_m2: Vec<Option<f64>>,
}

impl MassAtJoint {
    /// Whether there is none.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// The mass of an accelerometer that moved from response to response, which its functions are freed of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accelerometer {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Its standard deviation, where the study states one, kg.
    pub standard_deviation_kg: Option<f64>,
}
