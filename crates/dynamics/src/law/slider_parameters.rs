//! Parameters that all laws that slip have: the stiffness while they stick, and the load at which they slip.

use super::declaration::{ActsOn, Parameter, Quantity, Range, Span, UnitRule};

/// The stiffness of a law that slips; each gives symbol and description.
pub(super) const STIFFNESS: Parameter = Parameter {
    symbol: "",
    key: "stiffness",
    span: Span::Dof,
    unit: UnitRule::LoadPer {
        displacement: 1,
        seconds: 0,
    },
    range: Range::NotNegative,
    quantity: Quantity {
        name: "SliderStiffness",
        nominal: [1e6, 1e4, 1e3],
        start: [0.0; 3],
    },
    description: "",
    acts_on: ActsOn {
        load: true,
        stored_energy: true,
        dissipated_power: true,
        escape: false,
    },
    grows_with_preload: false,
};

/// The load at which it slips: what presses makes what slides.
pub(super) const SLIP_FORCE: Parameter = Parameter {
    key: "slip_force",
    unit: UnitRule::LoadPer {
        displacement: 0,
        seconds: 0,
    },
    quantity: Quantity {
        name: "SlipForce",
        nominal: [100.0, 10.0, 1.0],
        start: [0.0; 3],
    },
    grows_with_preload: true,
    ..STIFFNESS
};
