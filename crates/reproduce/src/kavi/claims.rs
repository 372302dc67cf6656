//! What the thesis says of its results, one by one, and what its equations give.

use std::fmt;

use serde::Serialize;

use bolted_joint_predict::layered_beam::{LayeredBeamError, NormalForceRule};

use super::specimens::{AMPLITUDE_M, BOUNDARIES, Placement, Setup, Specimen};

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
    pub source: &'static str,
    /// What it says.
    pub statement: &'static str,
    /// What is compared.
    pub compared: String,
    /// What the equations give there.
    pub obtained: Vec<f64>,
    /// Whether it follows.
    pub verdict: Verdict,
    /// Why, or why not.
    pub remark: String,
}

const OVER_FIRST: &str = "ζ over that of the first";

/// ζ of specimens over that of the first of them.
fn relative(numbers: &[usize], setup: &Setup) -> Result<Vec<f64>, LayeredBeamError> {
    let of = |&number: &usize| Specimen::numbered(number).damping(setup, AMPLITUDE_M);
    let all = numbers.iter().map(of).collect::<Result<Vec<f64>, _>>()?;
    Ok(all.iter().map(|damping| damping / all[0]).collect())
}

/// Whether numbers grow all the way.
fn grows(values: &[f64]) -> bool {
    values.windows(2).all(|pair| pair[1] > pair[0])
}

/// The verdict on a statement that ζ grows.
fn on_growth(values: &[f64]) -> Verdict {
    if grows(values) {
        Verdict::Follows
    } else {
        Verdict::Opposite
    }
}

fn list(values: &[f64]) -> String {
    let words = values.iter().map(|value| format!("{value:.3}"));
    words.collect::<Vec<_>>().join(", ")
}

pub(super) fn all() -> Result<Vec<Claim>, LayeredBeamError> {
    let kavi = Setup::KAVI;
    let steel = |number: usize| Specimen::numbered(number);
    let mut all = Vec::new();
    let touching = Setup {
        placement: Placement::ZonesTouch,
        ..kavi
    };

    let lengths = relative(&[1, 2, 3], &kavi)?;
    let close = relative(&[1, 2, 3], &touching)?;
    all.push(Claim {
        source: "6 (a), 7.1 (5)",
        statement: "damping grows with the length",
        compared: format!("specimens 1, 2, 3 (370, 430, 500 mm): {OVER_FIRST}"),
        verdict: on_growth(&lengths),
        remark: format!(
            "as L²: k falls as L⁻³, slopes as L⁻¹. The reason given, more rivets on a longer beam, is not in Table 5.1: all three have six. With rivets one zone of pressure apart instead of spread over the length: {}",
            list(&close)
        ),
        obtained: lengths,
    });

    let amplitudes = [1e-4, 2e-4, 3e-4].map(|amplitude| steel(1).damping(&kavi, amplitude));
    let amplitudes: Vec<f64> = amplitudes.into_iter().collect::<Result<_, _>>()?;
    let falls: Vec<f64> = amplitudes
        .iter()
        .map(|damping| damping / amplitudes[0])
        .collect();
    all.push(Claim {
        source: "6 (b), 7.1 (7)",
        statement: "damping falls with the amplitude",
        compared: format!("specimen 1 at 0.1, 0.2, 0.3 mm: {OVER_FIRST}"),
        verdict: on_growth(&falls.iter().map(|damping| -damping).collect::<Vec<_>>()),
        remark: "as 1/w, with one α′μ at all amplitudes: friction's energy grows as w, the stored one as w²".to_owned(),
        obtained: falls,
    });
    all.push(Claim {
        source: "6 (b)",
        statement: "α′μ grows with the amplitude",
        compared: "the text alone".to_owned(),
        obtained: Vec::new(),
        verdict: Verdict::Contradicted,
        remark: "section 5.5 says that it falls with the amplitude; the curves that it was taken from are not printed".to_owned(),
    });

    let diameters = relative(&[6, 3, 7], &kavi)?;
    all.push(Claim {
        source: "6 (c), 7.1 (8)",
        statement: "damping grows with the diameter of the rivets",
        compared: format!("specimens 6, 3, 7 (6, 8, 10 mm): {OVER_FIRST}"),
        verdict: on_growth(&diameters),
        remark: "as d², like the tension at one initial stress. That the stiffness grows with the diameter, too, is not in the equations".to_owned(),
        obtained: diameters,
    });

    let ratios = relative(&[2, 4, 5], &kavi)?;
    let balanced = Setup {
        rule: NormalForceRule::Tension,
        ..kavi
    };
    let in_balance = relative(&[2, 4, 5], &balanced)?;
    all.push(Claim {
        source: "6 (9.), 7.1 (2), (6)",
        statement: "damping is largest for layers of equal thickness",
        compared: format!("specimens 2, 4, 5 (thickness ratio 1, 1.5, 2): {OVER_FIRST}"),
        verdict: on_growth(&ratios.iter().map(|damping| -damping).collect::<Vec<_>>()),
        remark: format!(
            "N/P is 0.895, 1.134, 1.279 and h1 + h2 the same: damping grows with the ratio. The pressure at the rivet is largest for ratio 1, but acts on a smaller zone. Neither width nor stiffness of the specimens depends on the ratio. With N = P, as equilibrium asks for: {}",
            list(&in_balance)
        ),
        obtained: ratios,
    });

    let layers = relative(&[2, 10, 11], &kavi)?;
    all.push(Claim {
        source: "6 (10.), 7.1 (10)",
        statement: "damping grows with the number of layers",
        compared: format!("specimens 2, 10, 11 (2, 3, 4 layers of 6 mm in all): {OVER_FIRST}"),
        verdict: on_growth(&layers),
        remark: "as (m − 1)/m: there are more interfaces, and less slip at each. The lower stiffness that the thesis adds is not in its equations".to_owned(),
        obtained: layers,
    });

    let rivets = relative(&[8, 1, 9], &kavi)?;
    let close = relative(&[8, 1, 9], &touching)?;
    all.push(Claim {
        source: "7.1 (9)",
        statement: "damping grows with the number of rivets",
        compared: format!("specimens 8, 1, 9 (4, 6, 8 rivets): {OVER_FIRST}"),
        verdict: on_growth(&rivets),
        remark: format!(
            "nearly as their number. With rivets one zone of pressure apart instead of spread over the length: {}",
            list(&close)
        ),
        obtained: rivets,
    });

    let ends = BOUNDARIES.map(|boundary| steel(1).damping(&Setup::with(boundary), AMPLITUDE_M));
    let ends: Vec<f64> = ends.into_iter().collect::<Result<_, _>>()?;
    let ends: Vec<f64> = ends.iter().map(|damping| damping / ends[0]).collect();
    all.push(Claim {
        source: "7.1 (1)",
        statement: "damping is least for fixed–fixed and largest for pinned–pinned ends",
        compared: format!("specimen 1, fixed–fixed, fixed–pinned, pinned–pinned: {OVER_FIRST}"),
        verdict: on_growth(&ends),
        remark: "nearly as the inverse of the modal stiffness: the slopes add up to about the same for one amplitude".to_owned(),
        obtained: ends,
    });
    let frequencies = BOUNDARIES.map(|boundary| steel(1).mode(&Setup::with(boundary), 1));
    let frequencies = frequencies.into_iter().map(|mode| Ok(mode?.frequency_hz()));
    let frequencies = frequencies.collect::<Result<Vec<f64>, LayeredBeamError>>()?;
    let ordered: Vec<f64> = frequencies.iter().map(|frequency| -frequency).collect();
    all.push(Claim {
        source: "7.1 (1)",
        statement: "frequencies are lowest for pinned–pinned and highest for fixed–fixed ends",
        compared: "specimen 1, fixed–fixed, fixed–pinned, pinned–pinned: f₁ in Hz".to_owned(),
        verdict: on_growth(&ordered),
        remark: "as λ²; with 7850 kg/m³, which the thesis does not print".to_owned(),
        obtained: frequencies,
    });

    let over_length = [1, 2, 3].map(|number| steel(number).mode(&kavi, 1));
    let over_length = over_length.into_iter().map(|mode| Ok(mode?.frequency_hz()));
    let over_length = over_length.collect::<Result<Vec<f64>, LayeredBeamError>>()?;
    let falling: Vec<f64> = over_length.iter().map(|frequency| -frequency).collect();
    all.push(Claim {
        source: "7.1 (5)",
        statement: "frequencies fall with the length",
        compared: "specimens 1, 2, 3, fixed–fixed: f₁ in Hz".to_owned(),
        verdict: on_growth(&falling),
        remark: "as L⁻²".to_owned(),
        obtained: over_length,
    });

    let materials = relative(&[1, 12], &kavi)?;
    all.push(Claim {
        source: "6 (11.)",
        statement: "aluminium damps more than steel",
        compared: format!("specimens 1, 12 with the same α′μ: {OVER_FIRST}"),
        verdict: on_growth(&materials),
        remark: "as 1/E; a larger coefficient of friction would add to it through α′μ, which the thesis does not print".to_owned(),
        obtained: materials,
    });

    let thicker = |scale: f64| {
        let setup = Setup {
            thickness_scale: scale,
            ..kavi
        };
        steel(1).damping(&setup, AMPLITUDE_M)
    };
    let (one, two) = (thicker(1.0)?, thicker(2.0)?);
    let thickness = vec![1.0, two / one];
    all.push(Claim {
        source: "6 (d), 7.1 (11)",
        statement: "damping falls with the thickness of the whole beam",
        compared: format!("specimen 1, and one of 6 + 6 mm, which is not in Table 5.1: {OVER_FIRST}"),
        verdict: on_growth(&[-thickness[0], -thickness[1]]),
        remark: "as t⁻²: k grows as t³, slip as t. No specimen shows it: all are 6 mm thick. That friction takes more energy at a higher frequency is not in its equations".to_owned(),
        obtained: thickness,
    });

    let softer = |ratio: f64| {
        let setup = Setup {
            stiffness_ratio: ratio,
            ..kavi
        };
        steel(1).damping(&setup, AMPLITUDE_M)
    };
    let reference = softer(1.0)?;
    let soft = [1.0, 0.95, 0.90].map(softer).into_iter();
    let soft = soft.map(|damping| Ok(damping? / reference));
    let soft = soft.collect::<Result<Vec<f64>, LayeredBeamError>>()?;
    all.push(Claim {
        source: "6 (6.)",
        statement: "the stiffer the jointed beam, the less damping",
        compared: format!("specimen 1 with k/k′ of 1, 0.95, 0.90: {OVER_FIRST}"),
        verdict: on_growth(&soft),
        remark:
            "as 1/k. The loss of 5 to 10 % itself was measured; nothing in the equations gives it"
                .to_owned(),
        obtained: soft,
    });
    let lower = [1.0, 0.95, 0.90].map(|ratio| {
        let setup = Setup {
            stiffness_ratio: ratio,
            ..kavi
        };
        steel(1).mode(&setup, 1)
    });
    let lower = lower.into_iter().map(|mode| Ok(mode?.frequency_hz()));
    let lower = lower.collect::<Result<Vec<f64>, LayeredBeamError>>()?;
    all.push(Claim {
        source: "6 (7.)",
        statement: "joints lower the frequencies, less so those of lower modes",
        compared: "specimen 1 with k/k′ of 1, 0.95, 0.90: f₁ in Hz".to_owned(),
        verdict: Verdict::NotInTheModel,
        remark: "the frequencies are computed for the solid section; with a measured k/k′ all modes fall by the same part".to_owned(),
        obtained: lower,
    });

    all.push(Claim {
        source: "6 (10.)",
        statement: "a layered beam damps 50 % more than a solid one",
        compared: "the text alone".to_owned(),
        obtained: Vec::new(),
        verdict: Verdict::NotInTheModel,
        remark: "the model of a solid beam has no damping: loss in the material and at the supports, E_0 of (3.37), is left out".to_owned(),
    });
    all.push(Claim {
        source: "6 (8.)",
        statement: "roughness does not change the damping",
        compared: "the text alone".to_owned(),
        obtained: Vec::new(),
        verdict: Verdict::Assumed,
        remark: "α′μ is taken as one constant whatever the surfaces".to_owned(),
    });
    let twice = Setup {
        alpha_mu: 2.0,
        ..kavi
    };
    let twice = steel(1).damping(&twice, AMPLITUDE_M)? / reference;
    all.push(Claim {
        source: "7.1 (3), (4)",
        statement: "damping grows with the slip ratio and the coefficient of friction",
        compared: format!("specimen 1 with α′μ of 1, 2: {OVER_FIRST}"),
        obtained: vec![1.0, twice],
        verdict: Verdict::Assumed,
        remark: "ζ is proportional to their product, which is put in; that the two are inverse to each other is not in the equations".to_owned(),
    });
    all.push(Claim {
        source: "5.5, 6 (d)",
        statement: "α′μ grows with the frequency",
        compared: "the text alone".to_owned(),
        obtained: Vec::new(),
        verdict: Verdict::NotInTheModel,
        remark: "no frequency is in E_f; the curves that it was taken from are not printed"
            .to_owned(),
    });
    let zone = |number: usize| {
        let specimen = steel(number);
        let rivets = specimen.rivets(&kavi)?;
        Ok::<_, LayeredBeamError>(1e3 * rivets.zone_diameter_m(&specimen.beam(&kavi)?))
    };
    all.push(Claim {
        source: "5.2",
        statement: "the specimens are as wide as the zones of pressure need",
        compared: "specimen 5: diameter of the zone and width in mm".to_owned(),
        obtained: vec![zone(5)?, 1e3 * super::specimens::WIDTH_M],
        verdict: Verdict::Contradicted,
        remark: "at thickness ratio 2 the zone of an 8 mm rivet is wider than specimens 5 and 16: part of N has no interface to act on".to_owned(),
    });
    all.push(Claim {
        source: "5.2",
        statement: "rivets are equispaced along the length, and one zone of pressure apart",
        compared: "specimen 1: pitch of six rivets over the length, and diameter of the zone in mm".to_owned(),
        obtained: vec![steel(1).length_mm / steel(1).rivets as f64, zone(1)?],
        verdict: Verdict::Contradicted,
        remark: "six zones of 33 mm are 198 mm long on a beam of 370 mm. Here the rivets are in the middles of six equal parts; what the other reading gives is said above".to_owned(),
    });
    Ok(all)
}
