//! The loops that are drawn: laws with their parameters, which are ours, amplitudes, and the reference of each.

use std::f64::consts::TAU;

use bolted_joint_dynamics::law::{DofLaws, Iwan, Jenkins, LuGre, Valanis};
use bolted_joint_dynamics::{JointLaw, Linear};
use bolted_joint_respond::HysteresisLoop;

use super::references::{self, Reference};
use super::{ChapterLaw, FrictionLoop, LawParameter};

const SLIP_FORCE_N: f64 = 4000.0;
const STIFFNESS_N_PER_M: f64 = 1.5e7;
/// Of the spring beside the Jenkins element, k_0 of (2.2).
const BESIDE_N_PER_M: f64 = 5e6;
/// Of the spring of a slider that has none: it gives way by 0.01 µm.
const RIGID_N_PER_M: f64 = 4e11;
const FREQUENCY_HZ: f64 = 20.0;
const VALANIS_AMPLITUDE_M: f64 = 3.2e-4;

const IWAN: Iwan = Iwan {
    slip_force: SLIP_FORCE_N,
    stiffness: STIFFNESS_N_PER_M,
    exponent: -0.3,
    ratio: 0.5,
};

/// Its damping beside the bristles is more than σ₁ (F_s − F_c)/F_c = 50 N·s/m, so that it never gives energy.
const LUGRE: LuGre = LuGre {
    stiffness: STIFFNESS_N_PER_M,
    bristle_damping: 100.0,
    damping: 60.0,
    slip_force: SLIP_FORCE_N,
    static_force: 6000.0,
    stribeck_velocity: 0.05,
};

const fn valanis(kappa: f64) -> Valanis {
    Valanis {
        stiffness: STIFFNESS_N_PER_M,
        slip_stiffness: 0.1 * STIFFNESS_N_PER_M,
        slip_force: SLIP_FORCE_N,
        kappa,
    }
}

/// A loop to draw.
pub(super) struct Case {
    law: Law,
    case: String,
    amplitude_m: f64,
    frequency_hz: Option<f64>,
}

/// A law with its parameters.
#[derive(Clone, Copy)]
enum Law {
    /// A slider alone, of this force, N.
    Signum(f64),
    /// A slider beside a spring of this stiffness, N/m.
    ElastoSlip(f64, Jenkins),
    Iwan(Iwan),
    LuGre(LuGre),
    Valanis(Valanis),
}

/// In the order of the thesis.
pub(super) fn all() -> impl Iterator<Item = Case> {
    let slow = |law, case: &str, amplitude_m| Case {
        law,
        case: case.to_owned(),
        amplitude_m,
        frequency_hz: None,
    };
    let at = |frequency_hz: f64, law, amplitude_m| Case {
        law,
        case: format!("{frequency_hz} Hz"),
        amplitude_m,
        frequency_hz: Some(frequency_hz),
    };
    let jenkins = Law::ElastoSlip(
        BESIDE_N_PER_M,
        Jenkins {
            stiffness: STIFFNESS_N_PER_M,
            slip_force: SLIP_FORCE_N,
        },
    );
    let all_slip_m = references::all_slip_m(&IWAN);
    let iwan = |case: &str, part: f64| slow(Law::Iwan(IWAN), case, part * all_slip_m);
    let first = [
        at(FREQUENCY_HZ, Law::Signum(SLIP_FORCE_N), 6e-4),
        slow(jenkins, "0.4 mm", 4e-4),
        slow(jenkins, "0.6 mm", 6e-4),
        iwan("half of φ_max", 0.5),
        iwan("1.5 φ_max", 1.5),
        slow(Law::LuGre(LUGRE), "slow", 1e-3),
        at(FREQUENCY_HZ, Law::LuGre(LUGRE), 1e-3),
    ];
    let rounded = [0.0, 0.5, 0.9, 0.99].map(|kappa| {
        let law = Law::Valanis(valanis(kappa));
        slow(law, &format!("κ = {kappa}"), VALANIS_AMPLITUDE_M)
    });
    first.into_iter().chain(rounded)
}

/// Heat of a cycle of Valanis' law with κ = 1, J.
pub(super) fn heat_without_micro_slip_j() -> f64 {
    references::without_micro_slip(&valanis(1.0), VALANIS_AMPLITUDE_M).heat_j
}

impl Case {
    pub(super) fn run(self) -> FrictionLoop {
        let omega_rad_per_s = self.frequency_hz.map(|hz| TAU * hz);
        let motion = HysteresisLoop {
            dof: 0,
            amplitude: self.amplitude_m,
            omega_rad_per_s,
        };
        let points = motion.points(&self.law.joint());
        let reference = self.law.reference(self.amplitude_m, omega_rad_per_s);
        let heat_j = points.last().map_or(0.0, |of| of.heat_j);
        FrictionLoop {
            law: self.law.of_chapter(),
            case: self.case,
            parameters: self.law.parameters(),
            amplitude_m: self.amplitude_m,
            frequency_hz: self.frequency_hz,
            force_at_tip_n: points.first().map_or(0.0, |of| of.load),
            reference_force_at_tip_n: reference.force_at_tip_n,
            heat_j,
            reference_heat_j: reference.heat_j,
            relative_difference: heat_j / reference.heat_j - 1.0,
            reference: reference.by,
            points,
        }
    }
}

impl Law {
    fn of_chapter(self) -> ChapterLaw {
        match self {
            Self::Signum(_) => ChapterLaw::Signum,
            Self::ElastoSlip(..) => ChapterLaw::ElastoSlip,
            Self::Iwan(_) => ChapterLaw::Iwan,
            Self::LuGre(_) => ChapterLaw::LuGre,
            Self::Valanis(_) => ChapterLaw::Valanis,
        }
    }

    /// The law as the program has it.
    fn joint(self) -> JointLaw<1> {
        let (beside, on) = match self {
            Self::Signum(slip_force) => {
                let stiffness = RIGID_N_PER_M;
                let slider = Jenkins {
                    stiffness,
                    slip_force,
                };
                (0.0, DofLaws::from(slider))
            }
            Self::ElastoSlip(beside, slider) => (beside, DofLaws::from(slider)),
            Self::Iwan(law) => (0.0, DofLaws::from(law)),
            Self::LuGre(law) => (0.0, DofLaws::from(law)),
            Self::Valanis(law) => (0.0, DofLaws::from(law)),
        };
        JointLaw {
            linear: Linear {
                stiffness: [[beside]],
                damping: [[0.0]],
            },
            on: [on],
        }
    }

    fn reference(self, amplitude_m: f64, omega_rad_per_s: Option<f64>) -> Reference {
        match self {
            Self::Signum(force_n) => references::signum(force_n, amplitude_m),
            Self::ElastoSlip(beside, slider) => {
                references::elasto_slip(beside, &slider, amplitude_m)
            }
            Self::Iwan(law) => references::sliders(&law, amplitude_m),
            Self::LuGre(law) => match omega_rad_per_s {
                None => references::slow_bristles(&law, amplitude_m),
                Some(omega) => references::bristles(&law, amplitude_m, omega),
            },
            Self::Valanis(law) => references::valanis(&law, amplitude_m),
        }
    }

    fn parameters(self) -> Vec<LawParameter> {
        let ours = |symbol, value, unit| LawParameter {
            symbol,
            value,
            unit,
            printed: None,
        };
        match self {
            Self::Signum(force_n) => vec![ours("F_c", force_n, "N")],
            Self::ElastoSlip(beside, slider) => vec![
                ours("k_0", beside, "N/m"),
                ours("k_1", slider.stiffness, "N/m"),
                ours("h_1", slider.slip_force, "N"),
            ],
            Self::Iwan(law) => vec![
                ours("F_S", law.slip_force, "N"),
                ours("K_T", law.stiffness, "N/m"),
                ours("χ", law.exponent, ""),
                ours("β", law.ratio, ""),
            ],
            Self::LuGre(law) => vec![
                ours("σ_0", law.stiffness, "N/m"),
                ours("σ_1", law.bristle_damping, "N·s/m"),
                ours("σ_2", law.damping, "N·s/m"),
                ours("F_c", law.slip_force, "N"),
                ours("F_s", law.static_force, "N"),
                ours("v_s", law.stribeck_velocity, "m/s"),
            ],
            Self::Valanis(law) => vec![
                ours("E_0", law.stiffness, "N/m"),
                ours("E_t", law.slip_stiffness, "N/m"),
                ours("σ_0", law.slip_force, "N"),
                ours("κ", law.kappa, ""),
            ],
        }
    }
}
