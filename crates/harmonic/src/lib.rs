//! Periodic responses of the lap model by harmonic balance: what it answers at each frequency and load, where that folds, whether
//! it persists, and how it depends on every number of the model.
//!
//! The motion is r(t) = a₀ + Σ (a_h cos hωt + b_h sin hωt), r = x_a − x_b: the bodies are linear, so they are condensed to the
//! relative motion and recovered from it. The joint's nonlinear force is sampled over a period and transformed back
//! (alternating frequency/time). Newton's method uses exact derivatives.
//!
//! ```
//! use bolted_joint_harmonic::{HarmonicBalance, HarmonicLoads, Harmonics, Observed, Parameter, Side};
//! use bolted_joint_dynamics::{Body, Lap, Linear, Polynomial, law::Term};
//!
//! # fn main() -> Result<(), bolted_joint_harmonic::HarmonicError> {
//! let body = Body { inertia: [2.35], stiffness: [10.56e5], damping: [1.39] };
//! let linear = Linear { stiffness: [[4.56e6]], damping: [[0.54]] };
//! let joint = linear.beside([Polynomial::cubic(1e12)]);
//! let lap = Lap { joint, a: body, b: body };
//! let balance = HarmonicBalance::new(&lap, Harmonics::odd(7)?)?;
//!
//! // One response, what a sensor on body b sees of its fundamental, and how that changes with k3 and m_a.
//! let response = balance.forced(2000.0, &HarmonicLoads::on_b(10.0), None)?;
//! let on_b = Observed::Body(Side::B, 0);
//! let x = balance.amplitude_of(&response, on_b, 1);
//! let parameters = [Parameter::Term(Term::CUBIC, 0), Parameter::Inertia(Side::A, 0)];
//! for change in balance.sensitivities(&response, &parameters)? {
//!     let dx = balance.amplitude_change(&response, &change, on_b, 1);
//!     println!("{:?}: {dx} of {x}", change.parameter);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! * [`HarmonicBalance::forced`]: frequency and loads given.
//! * [`HarmonicBalance::controlled`]: frequency and an amplitude given; the loads follow ([`Solution::load_factor`]).
//! * [`HarmonicBalance::resonance`]: an amplitude given; the frequency of phase resonance and the loads follow.
//! * [`HarmonicBalance::free`]: an amplitude given; frequency and damping ratio of the free motion follow.
//! * [`HarmonicBalance::sensitivities`]: derivatives of any of these with respect to [`Parameter`]s, of the amplitudes through
//!   [`HarmonicBalance::amplitude_change`], of frequency, loads and damping ratio in [`Sensitivity`].
//! * [`HarmonicBalance::forced_curve`], [`HarmonicBalance::controlled_curve`], [`HarmonicBalance::resonance_curve`],
//!   [`HarmonicBalance::backbone`]: curves through folds, by continuation.
//! * [`HarmonicBalance::stability`]: Floquet multipliers.
//!
//! Friction is balanced with as many harmonics as anything else, by the exact loads of its laws on each branch of the motion
//! between two turns; LuGre's alone is not, whose load depends on how fast the joint slips.
#![forbid(unsafe_code)]

mod balance;
mod branches;
mod condensed;
mod continuation;
mod course;
mod curve;
mod deviation;
mod error;
mod harmonics;
mod loads;
mod masing;
mod modes;
mod observed;
mod parameter;
mod quadrature;
mod sampling;
mod sensitivity;
mod slipping;
mod solution;
mod stability;
mod system;

pub use balance::HarmonicBalance;
pub use branches::Remembering;
pub use continuation::Steps;
pub use curve::{CurveOptions, CurvePoint};
pub use error::HarmonicError;
pub use harmonics::Harmonics;
pub use loads::HarmonicLoads;
pub use masing::{Fundamental, masing_fundamental};
pub use modes::LinearMode;
pub use observed::{Derivative, Observed, Target};
pub use parameter::{Parameter, Side};
pub use sensitivity::Sensitivity;
pub use solution::Solution;
pub use stability::Stability;
