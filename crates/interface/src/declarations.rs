//! What the laws of the joint say of themselves, until the laws say it.

use bolted_joint_dynamics::law::{ActsOn, Declaration, Parameter, Quantity, Range, Span, UnitRule};

const fn parameter(
    symbol: &'static str,
    key: &'static str,
    displacement: u8,
    seconds: u8,
    quantity: Quantity,
    description: &'static str,
    acts_on: ActsOn,
) -> Parameter {
    Parameter {
        symbol,
        key,
        span: Span::Dof,
        unit: UnitRule {
            displacement,
            seconds,
        },
        range: Range::Any,
        quantity,
        description,
        acts_on,
    }
}

const fn quantity(name: &'static str, nominal: [f64; 3], start: [f64; 3]) -> Quantity {
    Quantity {
        name,
        nominal,
        start,
    }
}

/// The laws.
pub(crate) const DECLARATIONS: &[Declaration] = &[
    Declaration {
        name: "linear",
        summary: "Stiffness and viscous damping, coupled between the DOFs",
        parameters: &[
            Parameter {
                span: Span::Matrix(
                    "Stiffness of the joint: {load} per relative {other_motion}, and {other_load} per relative {motion}",
                ),
                ..parameter(
                    "k",
                    "stiffness",
                    1,
                    0,
                    quantity("Stiffness", [1e6, 1e4, 1e3], [5.73e5, 5.82e3, 1.29e3]),
                    "Stiffness of the joint: {load} per relative {motion}",
                    ActsOn::SPRING,
                )
            },
            Parameter {
                span: Span::Matrix(
                    "Damping of the joint: {load} per relative {other_rate}, and {other_load} per relative {rate}",
                ),
                ..parameter(
                    "c",
                    "damping",
                    1,
                    1,
                    quantity("Damping", [10.0, 1.0, 0.1], [10.83, -0.83, 0.083]),
                    "Damping of the joint: {load} per relative {rate}",
                    ActsOn::DAMPER,
                )
            },
        ],
        memory: &[],
    },
    Declaration {
        name: "polynomial",
        summary: "Springs and dampers that are powers of the relative displacement",
        parameters: &[
            parameter(
                "k3",
                "cubic",
                3,
                0,
                quantity("CubicStiffness", [1e12, 1e9, 1e6], [0.0; 3]),
                "Cubic stiffness of the joint in {motion}: positive hardens, negative softens",
                ActsOn::SPRING,
            ),
            parameter(
                "k5",
                "quintic",
                5,
                0,
                quantity("QuinticStiffness", [1e18, 1e13, 1e9], [0.0; 3]),
                "Stiffness of fifth order of the joint in {motion}",
                ActsOn::SPRING,
            ),
            parameter(
                "k7",
                "septic",
                7,
                0,
                quantity("SepticStiffness", [1e24, 1e18, 1e12], [0.0; 3]),
                "Stiffness of seventh order of the joint in {motion}",
                ActsOn::SPRING,
            ),
            parameter(
                "c2",
                "damping_quadratic",
                3,
                1,
                quantity("QuadraticDamping", [1e7, 3e4, 100.0], [0.0; 3]),
                "Damping of the joint that grows with the square of the relative {motion}",
                ActsOn::DAMPER,
            ),
            parameter(
                "c4",
                "damping_quartic",
                5,
                1,
                quantity("QuarticDamping", [1e13, 1e9, 1e5], [0.0; 3]),
                "Damping of the joint that grows with the fourth power of the relative {motion}",
                ActsOn::DAMPER,
            ),
        ],
        memory: &[],
    },
];
