//! All uncertain values of a prediction together: their names, distributions, and pairs that are correlated.

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, StandardNormal};

use super::distribution::Distribution;
use crate::number::{NumberError, check};

/// The uncertain values of a prediction. Those that are exact take part, but no random numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Inputs {
    inputs: Vec<Input>,
}

#[derive(Debug, Clone, PartialEq)]
struct Input {
    name: String,
    distribution: Distribution,
    /// Place of an earlier input and the correlation with it.
    with: Option<(usize, f64)>,
}

/// Place of an input among [`Inputs`], to find its value again among those drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InputPlace(usize);

impl Inputs {
    /// One more input.
    pub fn add(&mut self, name: impl Into<String>, distribution: Distribution) -> InputPlace {
        self.inputs.push(Input {
            name: name.into(),
            distribution,
            with: None,
        });
        InputPlace(self.inputs.len() - 1)
    }

    /// One more input, whose score is correlated with that of an earlier one.
    ///
    /// # Errors
    /// The correlation is not between −1 and 1.
    pub fn add_correlated(
        &mut self,
        name: impl Into<String>,
        distribution: Distribution,
        with: InputPlace,
        correlation: f64,
    ) -> Result<InputPlace, NumberError> {
        let valid = (-1.0..=1.0).contains(&correlation);
        check(
            valid,
            "the correlation",
            correlation,
            "",
            "a number between −1 and 1",
        )?;
        let place = self.add(name, distribution);
        self.inputs[place.0].with = Some((with.0, correlation));
        Ok(place)
    }

    /// Number of inputs, the exact ones too.
    #[must_use]
    pub fn len(&self) -> usize {
        self.inputs.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.inputs.is_empty()
    }

    /// Whether none of them varies.
    #[must_use]
    pub fn are_exact(&self) -> bool {
        self.varying().next().is_none()
    }

    /// The values as they were given, without any draw.
    #[must_use]
    pub fn nominal(&self) -> Drawn {
        let values = self.inputs.iter();
        Drawn {
            values: values.map(|input| input.distribution.nominal()).collect(),
        }
    }

    /// Names and distributions of all inputs, in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Distribution)> {
        let inputs = self.inputs.iter();
        inputs.map(|input| (input.name.as_str(), &input.distribution))
    }

    /// Places of those that vary.
    pub(super) fn varying(&self) -> impl Iterator<Item = usize> {
        let inputs = self.inputs.iter().enumerate();
        inputs.filter_map(|(place, input)| (!input.distribution.is_exact()).then_some(place))
    }

    pub(super) fn name(&self, place: usize) -> &str {
        &self.inputs[place].name
    }

    /// Draws a standard normal score for each.
    pub(super) fn scores(&self, generator: &mut ChaCha8Rng) -> Vec<f64> {
        let mut scores: Vec<f64> = Vec::with_capacity(self.inputs.len());
        for input in &self.inputs {
            let own: f64 = match input.distribution.is_exact() {
                true => 0.0,
                false => StandardNormal.sample(generator),
            };
            scores.push(match input.with {
                // z = ρ z₀ + √(1 − ρ²) ε
                Some((earlier, rho)) => rho * scores[earlier] + (1.0 - rho * rho).sqrt() * own,
                None => own,
            });
        }
        scores
    }

    /// The values at given scores; the name of the first input that has no meaning there otherwise.
    pub(super) fn at(&self, scores: &[f64]) -> Result<Drawn, &str> {
        let pairs = self.inputs.iter().zip(scores);
        let values = pairs.map(|(input, &score)| {
            let value = input.distribution.at(score);
            value.ok_or(input.name.as_str())
        });
        Ok(Drawn {
            values: values.collect::<Result<_, _>>()?,
        })
    }
}

/// One value of each input.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    values: Vec<f64>,
}

impl Drawn {
    /// The value of the input at this place.
    #[must_use]
    pub fn of(&self, place: InputPlace) -> f64 {
        self.values[place.0]
    }
}
