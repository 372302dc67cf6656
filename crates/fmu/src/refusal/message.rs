//! What the importer's user reads of a refusal.

use std::fmt;

use super::{NotIntermediate, Refusal};
use crate::{interface::Role, mode::Mode};

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WrongMode { found, expected } => {
                write!(f, "is not allowed in state {found}, only in ")?;
                for (index, mode) in expected.iter().enumerate() {
                    let separator = if index == 0 { "" } else { " or " };
                    write!(f, "{separator}{mode}")?;
                }
                if *found == Mode::Terminated {
                    f.write_str("; reset the instance or restore a saved state to continue")?;
                }
                Ok(())
            }
            Self::OtherAbi { found, expected } => write!(
                f,
                "belongs to {}, but the instance was made by the functions of {}; use only one of them",
                expected.words().version,
                found.words().version
            ),
            Self::InsideStep => f.write_str(
                "is not allowed in state Intermediate Update Mode, only when the communication step has ended",
            ),
            Self::EventModeNotUsed => f.write_str(
                "is not allowed: the instance was made with eventModeUsed = fmi3False",
            ),
            Self::OtherInterfaceType { found, expected } => write!(
                f,
                "is not provided by this FMU: it belongs to {}, the instance is for {}",
                expected.name(),
                found.name()
            ),
            Self::UnknownReference { reference } => write!(
                f,
                "value reference {reference} does not exist; take it from modelDescription.xml"
            ),
            Self::NotOfType { name, own, asked } => write!(
                f,
                "variable {name} is of type {own}, not {asked}; use the {own} function"
            ),
            Self::NotSettable { name, role, mode } => {
                write!(f, "variable {name} is {role} and cannot be set in state {mode}")?;
                match (role, mode) {
                    (Role::Parameter, Mode::Step | Mode::ContinuousTime) => {
                        f.write_str("; enter Event Mode first")
                    }
                    _ => Ok(()),
                }
            }
            Self::NotIntermediate { name, reason } => {
                write!(f, "variable {name} {reason}")
            }
            Self::EarlyReturnNotAllowed => f.write_str(
                "earlyReturnRequested was set by the callback though canReturnEarly was fmi3False: the instance was \
                 made with earlyReturnAllowed = fmi3False",
            ),
            Self::EarlyReturnTime { found_s, start_s, end_s } => write!(
                f,
                "earlyReturnTime is {found_s} s, expected a time within the step from {start_s} s to {end_s} s"
            ),
            Self::NoIntermediateUpdate => f.write_str(
                "requiredIntermediateVariables is not empty, but the callback intermediateUpdate is a null pointer",
            ),
            Self::ValueNotFinite { name, value } => {
                write!(f, "variable {name} cannot be set to {value}; expected a finite number")
            }
            Self::OutputNotFinite { name, unit, time_s } => write!(
                f,
                "variable {name} overflows at t = {time_s} s: its inputs and parameters give no finite number in {unit}"
            ),
            Self::Preload {
                found_n_m,
                first_n_m,
                last_n_m,
                time_s,
            } => {
                write!(f, "preload is {found_n_m} N.m")?;
                if let Some(time_s) = time_s {
                    write!(f, " at t = {time_s} s")?;
                }
                write!(
                    f,
                    ", expected {first_n_m} to {last_n_m} N.m: the table of the joint says nothing beyond; export the FMU with \
                     --extrapolate to hold its ends"
                )
            }
            Self::NoOutputDerivative { name, role } => write!(
                f,
                "variable {name} is {role} and no output; ask for the derivative of an output"
            ),
            Self::NoInputDerivative { name, role } => write!(
                f,
                "variable {name} is {role} and no input; derivatives can be given for inputs alone"
            ),
            Self::DerivativeOrder { name, found, highest: 1 } => write!(
                f,
                "the order of the derivative of variable {name} is {found}, expected 1"
            ),
            Self::DerivativeOrder { name, found, highest } => write!(
                f,
                "the order of the derivative of variable {name} is {found}, expected 1 to {highest}"
            ),
            Self::InputNotFinite { name, time_s } => write!(
                f,
                "input {name} overflows before t = {time_s} s with the derivatives that were given; give others or \
                 take a shorter step"
            ),
            Self::NoDerivatives { mode } => write!(
                f,
                "is not allowed in state {mode}; partial derivatives are there from Initialization Mode on, at \
                 communication points"
            ),
            Self::NotUnknown { name, role, mode } => write!(
                f,
                "variable {name} is {role} and no unknown in state {mode}; ask for the derivative of an output"
            ),
            Self::NotKnown { name, role } => write!(
                f,
                "variable {name} is {role} and no known; differentiate by inputs, states and parameters"
            ),
            Self::SeedNotFinite { name, seed } => {
                write!(f, "the seed of variable {name} is {seed}; expected a finite number")
            }
            Self::DerivativeNotFinite { name, time_s } => write!(
                f,
                "the derivative for variable {name} overflows at t = {time_s} s with this seed"
            ),
            Self::NullPointer { argument } => write!(f, "argument {argument} is a null pointer"),
            Self::BadArray { argument } => {
                write!(f, "argument {argument} does not point to an array of that type and length")
            }
            Self::NotUtf8 { argument } => write!(f, "argument {argument} is not UTF-8"),
            Self::Empty { argument } => write!(f, "argument {argument} is an empty string"),
            Self::Count { argument, found, expected } => write!(
                f,
                "argument {argument} is {found}, expected {expected}: every variable is a scalar"
            ),
            Self::StateCount { argument, found, expected } => write!(
                f,
                "argument {argument} is {found}, expected {expected}, the number of continuous states"
            ),
            Self::IndicatorCount { argument, found, expected: 0 } => write!(
                f,
                "argument {argument} is {found}, expected 0: there are no event indicators"
            ),
            Self::IndicatorCount { argument, found, expected } => write!(
                f,
                "argument {argument} is {found}, expected {expected}, the number of event indicators"
            ),
            Self::Size { found, expected } => write!(
                f,
                "argument size is {found}, but the serialised FMU state has {expected} bytes"
            ),
            Self::StartTime { found_s } => write!(f, "startTime is {found_s}, expected a finite number"),
            Self::StopTime { start_s, found_s } => write!(
                f,
                "stopTime is {found_s}, expected a finite number not before startTime = {start_s} s"
            ),
            Self::Time { found_s } => write!(f, "time is {found_s}, expected a finite number"),
            Self::StepSize { found_s } => write!(
                f,
                "communicationStepSize is {found_s}, expected a finite number greater than zero"
            ),
            Self::StepVanishes { current_s, interval_s } => write!(
                f,
                "communicationStepSize = {interval_s} s is lost to rounding at t = {current_s} s; take a longer step"
            ),
            Self::CommunicationPoint { found_s, expected_s } => write!(
                f,
                "currentCommunicationPoint is {found_s} s, but the FMU is at t = {expected_s} s"
            ),
            Self::PastStop { end_s, stop_s } => write!(
                f,
                "the step would end at t = {end_s} s, after stopTime = {stop_s} s"
            ),
            Self::TooManySubsteps { interval_s, step_size_max_s, most } => write!(
                f,
                "a communication step of {interval_s} s with step_size_max = {step_size_max_s} s takes more than \
                 {most} Runge-Kutta steps; shorten the one or raise the other"
            ),
            Self::Inertia { name, unit, found } => write!(
                f,
                "parameter {name} is {found} {unit}, expected a number greater than zero"
            ),
            Self::OutsideLaw {
                name,
                found,
                expected,
            } => write!(f, "parameter {name} is {found}, expected {expected}"),
            Self::NotUsable => f.write_str(
                "the parameters give no equations of motion that can be integrated; bring their magnitudes closer together",
            ),
            Self::StepSizeMax { found_s } => write!(
                f,
                "parameter step_size_max is {found_s} s, expected a number greater than zero"
            ),
            Self::UnstableStep { step_s, advised_s } => write!(
                f,
                "Runge-Kutta steps of step_size_max = {step_s} s diverge with these parameters; set step_size_max to \
                 {advised_s:e} s or less"
            ),
            Self::Escape { a, b, unit, relative, amplitude, time_s } => write!(
                f,
                "{a} - {b} = {relative:e} {unit} at t = {time_s} s is past {amplitude:e} {unit}, where the softening \
                 joint no longer holds and the motion diverges; reduce the load or check the joint's nonlinear stiffness"
            ),
            Self::StateNotFinite { name, time_s } => write!(
                f,
                "state {name} is no finite number at t = {time_s} s: the motion diverges; check loads, parameters and \
                 step_size_max"
            ),
            Self::GrowsWithinStep { interval_s, time_s } => write!(
                f,
                "the motion grows beyond all bounds in a step of {interval_s} s from t = {time_s} s: a joint or a structure \
                 feeds energy, or the step is far too long"
            ),
            Self::TooLongForJoints { interval_s, time_s } => write!(
                f,
                "the joints are so stiff at t = {time_s} s that 4096 parts of a step of {interval_s} s are too long for them; \
                 take shorter communication steps"
            ),
            Self::UnknownCategory { found } => write!(
                f,
                "log category \"{found}\" does not exist; take it from <LogCategories> in modelDescription.xml"
            ),
            Self::ForeignState => f.write_str("argument FMUState was not made by this library, or is already freed"),
            Self::State(error) => error.fmt(f),
            Self::Token { argument, found, expected } => write!(
                f,
                "{argument} is \"{found}\", but the FMU's resources have \"{expected}\"; \
                 pass the token of the same FMU's modelDescription.xml"
            ),
            Self::FmuType { found } => write!(
                f,
                "fmuType is {found}, expected 0 (fmi2ModelExchange) or 1 (fmi2CoSimulation)"
            ),
            Self::NoStepUnderWay { mode } => write!(
                f,
                "is not allowed in state {mode}: a step is done when fmi2DoStep returns, there is none to cancel"
            ),
            Self::NoStatus { kind } => write!(
                f,
                "has no status of kind {kind}; no step is ever pending, so that there are fmi2LastSuccessfulTime (of \
                 type Real) and fmi2Terminated (of type Boolean) only"
            ),
            Self::NotProvided { reason } => write!(f, "is not provided by this FMU: {reason}"),
            Self::Resource(error) => error.fmt(f),
            Self::Internal => f.write_str("failed by a defect in the FMU's library; please report it"),
        }
    }
}

impl fmt::Display for NotIntermediate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotOffered => "has no intermediateUpdate in modelDescription.xml",
            Self::NotRequired => {
                "cannot be accessed within a communication step: it is not among the requiredIntermediateVariables"
            }
            Self::NoGet => "cannot be read now: intermediateVariableGetAllowed is fmi3False",
            Self::NoSet => "cannot be set now: intermediateVariableSetRequested is fmi3False",
        })
    }
}
