//! What the thesis says of its results, one by one, and what its equations give.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::specimens::{Setup, Specimen, WIDTH_M};
use crate::ReproduceError;

/// Whether a statement follows from the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It does.
    Follows,
    /// The equations give the opposite.
    Opposite,
    /// The equations do not have what it is about.
    NotInTheModel,
    /// It is what was put in.
    Assumed,
    /// The thesis says the opposite elsewhere.
    Contradicted,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Follows => "follows",
            Self::Opposite => "the opposite",
            Self::NotInTheModel => "not in the model",
            Self::Assumed => "assumed",
            Self::Contradicted => "contradicted",
        })
    }
}

/// One statement.
#[derive(Clone, Debug, Serialize)]
pub struct Claim {
    /// Where it stands.
    pub source: String,
    /// What it says.
    pub statement: String,
    /// What is compared.
    pub compared: String,
    /// What the equations give there.
    pub obtained: Vec<f64>,
    /// Whether it follows.
    pub verdict: Verdict,
    /// Why, or why not.
    pub remark: String,
}

/// `claims.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Statements {
    #[serde(rename = "claim")]
    claims: Vec<Statement>,
}

/// A statement, and how it is checked.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Statement {
    source: String,
    statement: String,
    compared: String,
    /// None for a statement that rests on the text alone.
    quantity: Option<Quantity>,
    #[serde(default)]
    specimens: Vec<usize>,
    #[serde(default = "as_published")]
    setups: Vec<Setup>,
    /// What the remark also tells the quantity for.
    beside: Option<Setup>,
    judged: Judged,
    remark: String,
}

fn as_published() -> Vec<Setup> {
    vec![Setup::default()]
}

/// What is compared.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Quantity {
    /// ζ of the first mode over that of the first specimen or setup.
    Damping,
    /// f₁, Hz.
    Frequency,
    /// Diameter of the zone of pressure, and width of the specimen, mm.
    ZoneAndWidth,
    /// Pitch of rivets spread over the length, and diameter of the zone of pressure, mm.
    PitchAndZone,
}

/// What decides whether a statement follows: the numbers, which should grow or fall all the way, or what the equations are about.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Judged {
    ByGrowth,
    ByFall,
    NotInTheModel,
    Assumed,
    Contradicted,
}

impl Judged {
    fn verdict(self, values: &[f64]) -> Verdict {
        let mut pairs = values.windows(2);
        let follows = match self {
            Self::ByGrowth => pairs.all(|pair| pair[1] > pair[0]),
            Self::ByFall => pairs.all(|pair| pair[1] < pair[0]),
            Self::NotInTheModel => return Verdict::NotInTheModel,
            Self::Assumed => return Verdict::Assumed,
            Self::Contradicted => return Verdict::Contradicted,
        };
        match follows {
            true => Verdict::Follows,
            false => Verdict::Opposite,
        }
    }
}

impl Statement {
    fn values(&self, setups: &[Setup]) -> Result<Vec<f64>, ReproduceError> {
        let mut values = Vec::new();
        for setup in setups {
            for specimen in self
                .specimens
                .iter()
                .map(|&number| Specimen::numbered(number))
            {
                let zone_mm = || specimen.zone_mm(setup);
                match self.quantity {
                    None => {}
                    Some(Quantity::Damping) => values.push(specimen.damping(setup)?),
                    Some(Quantity::Frequency) => {
                        values.push(specimen.mode(setup, 1)?.frequency_hz());
                    }
                    Some(Quantity::ZoneAndWidth) => values.extend([zone_mm()?, 1e3 * WIDTH_M]),
                    Some(Quantity::PitchAndZone) => {
                        let pitch_mm = specimen.length_mm / specimen.rivets as f64;
                        values.extend([pitch_mm, zone_mm()?]);
                    }
                }
            }
        }
        if let (Some(Quantity::Damping), Some(&first)) = (self.quantity, values.first()) {
            values.iter_mut().for_each(|damping| *damping /= first);
        }
        Ok(values)
    }

    fn checked(self) -> Result<Claim, ReproduceError> {
        let obtained = self.values(&self.setups)?;
        let beside = self.values(self.beside.as_slice())?;
        let beside: Vec<String> = beside.iter().map(|value| format!("{value:.3}")).collect();
        Ok(Claim {
            verdict: self.judged.verdict(&obtained),
            obtained,
            remark: self.remark.replace("{}", &beside.join(", ")),
            source: self.source,
            statement: self.statement,
            compared: self.compared,
        })
    }
}

pub(super) fn all() -> Result<Vec<Claim>, ReproduceError> {
    let Statements { claims } = toml::from_str(include_str!("claims.toml"))?;
    claims.into_iter().map(Statement::checked).collect()
}
