//! `predict`: a joint from surfaces, materials and bolts, before anything is built.

mod interface;
mod layered_beam;
mod outputs;

use super::PredictArguments;
use super::error::CliError;
use crate::predict::study::PredictionMethod;

pub(super) fn run(arguments: &PredictArguments) -> Result<(), CliError> {
    match PredictionMethod::read(&arguments.study)? {
        method @ (PredictionMethod::FractalContact | PredictionMethod::VirtualMaterial) => {
            interface::run(arguments, method)
        }
        PredictionMethod::LayeredBeam => layered_beam::run(arguments),
    }
}
