//! Chapter 2.2 of Tol's thesis: its joint laws as closed loops of this program's laws, each beside a result that these had no
//! part in. The thesis prints equations and figures, but no parameters.

mod cases;
mod readings;
mod references;

use serde::Serialize;

use bolted_joint_respond::LoopPoint;

pub use readings::LoopReading;

/// What the thesis leaves open, and what was taken instead.
const NOT_GIVEN: [&str; 5] = [
    "parameters of any law: all are ours",
    "amplitudes and frequencies of the loops: ours, so that each law slips; signum friction is the same at any frequency",
    "densities of the sliders in figure 2.4: that of D. J. Segalman, J. Appl. Mech. 72 (2005) 752, taken",
    "equations of the LuGre law, for which it names Canudas de Wit et al. (1995): theirs taken",
    "λ of (2.3): E_0/(σ_0 (1 − κ E_t/E_0)) taken, as Gaul and Nitsche (2001) have it; then σ_0 is where the lines of slope E_0 and E_t meet",
];

/// Where the thesis and its equations part.
const DIFFERENCES: [&str; 3] = [
    "Figure 2.3 is said to show force and velocity, but (2.2) gives force over displacement, as it is drawn here.",
    "(2.2) has x⁺ as the displacement prior to the reversal, and does not explain ẋ⁺. It must be the velocity after the reversal: with that before \
     it the force would jump from h to −h. And (2.2) holds only where the element slipped before: the program remembers the slider's place instead.",
    "Signum friction has no stiffness. It is drawn as a slider on a spring that gives way by h/k = 0.01 µm, which is what its heat lacks.",
];

/// The chapter computed anew.
#[derive(Clone, Debug, Serialize)]
pub struct FrictionReproduction {
    /// Its figures.
    pub figures: Vec<ChapterFigure>,
    /// Its laws as closed loops.
    pub loops: Vec<FrictionLoop>,
    /// Parameters as they would be read from these loops.
    pub readings: Vec<LoopReading>,
    /// Heat of a cycle of Valanis' law with κ = 1 (J), which has no micro-slip: the area of a parallelogram.
    pub heat_without_micro_slip_j: f64,
    /// What the thesis does not give, and what was taken instead.
    pub not_given: Vec<&'static str>,
    /// Where the thesis and its equations part.
    pub differences: Vec<&'static str>,
}

/// A figure of the chapter.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ChapterFigure {
    /// Its number, or those of two.
    pub number: &'static str,
    /// What it shows by its caption and by the text.
    pub shows: &'static str,
    /// What is drawn of it here.
    pub drawn: &'static str,
}

const FIGURES: [ChapterFigure; 6] = [
    ChapterFigure {
        number: "figure 2.1",
        shows: "signum friction: force over velocity, (2.1)",
        drawn: "this, and the loop of force over displacement",
    },
    ChapterFigure {
        number: "figure 2.2",
        shows: "generalised elasto-slip: the sketch of a spring and Jenkins elements in parallel",
        drawn: "nothing",
    },
    ChapterFigure {
        number: "figure 2.3",
        shows: "elasto-slip: the force of (2.2)",
        drawn: "loops of one element beside a spring",
    },
    ChapterFigure {
        number: "figure 2.4",
        shows: "stiffness of many Jenkins elements in parallel, after Iwan",
        drawn: "loops of Iwan's law",
    },
    ChapterFigure {
        number: "figures 2.5 and 2.6",
        shows: "LuGre: sketches of bristles",
        drawn: "loops of the law",
    },
    ChapterFigure {
        number: "figure 2.7",
        shows: "Valanis: a closed hysteresis, (2.3)",
        drawn: "loops with four κ",
    },
];

/// A law of the chapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ChapterLaw {
    /// (2.1)
    Signum,
    /// (2.2) with one Jenkins element.
    ElastoSlip,
    /// Very many Jenkins elements.
    Iwan,
    /// Bristles.
    LuGre,
    /// (2.3)
    Valanis,
}

impl ChapterLaw {
    /// All in the order of the thesis.
    pub const ALL: [Self; 5] = [
        Self::Signum,
        Self::ElastoSlip,
        Self::Iwan,
        Self::LuGre,
        Self::Valanis,
    ];

    /// Its name, and where the thesis has it.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Signum => "Signum friction, (2.1)",
            Self::ElastoSlip => "Elasto-slip, (2.2)",
            Self::Iwan => "Iwan",
            Self::LuGre => "LuGre",
            Self::Valanis => "Valanis, (2.3)",
        }
    }

    /// The figures that belong to it.
    #[must_use]
    pub fn figures(self) -> &'static str {
        match self {
            Self::Signum => "figure 2.1",
            Self::ElastoSlip => "figure 2.3",
            Self::Iwan => "to figure 2.4",
            Self::LuGre => "to figures 2.5 and 2.6",
            Self::Valanis => "figure 2.7",
        }
    }
}

/// A parameter of a law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LawParameter {
    /// As the thesis or the law's author writes it.
    pub symbol: &'static str,
    /// What was taken.
    pub value: f64,
    /// Its unit; empty for a number.
    pub unit: &'static str,
    /// What the thesis prints.
    pub printed: Option<f64>,
}

/// A closed loop of a law.
#[derive(Clone, Debug, Serialize)]
pub struct FrictionLoop {
    /// Which law.
    pub law: ChapterLaw,
    /// What tells it from the other loops of the law.
    pub case: String,
    /// What the law was computed with.
    pub parameters: Vec<LawParameter>,
    /// Amplitude of the displacement, m.
    pub amplitude_m: f64,
    /// `None` for a motion so slow that velocity has no part in it.
    pub frequency_hz: Option<f64>,
    /// Force at the largest displacement, N.
    pub force_at_tip_n: f64,
    /// The same without the program's law, N.
    pub reference_force_at_tip_n: f64,
    /// Heat of a cycle, J.
    pub heat_j: f64,
    /// The same without the program's law, J.
    pub reference_heat_j: f64,
    /// `heat_j` over `reference_heat_j`, less one.
    pub relative_difference: f64,
    /// What the reference is.
    pub reference: &'static str,
    /// The loop itself.
    #[serde(skip)]
    pub points: Vec<LoopPoint>,
}

/// Computes the chapter's laws anew.
#[must_use]
pub fn friction() -> FrictionReproduction {
    let loops: Vec<FrictionLoop> = cases::all().map(|case| case.run()).collect();
    FrictionReproduction {
        figures: FIGURES.to_vec(),
        readings: readings::all(&loops),
        heat_without_micro_slip_j: cases::heat_without_micro_slip_j(),
        loops,
        not_given: NOT_GIVEN.to_vec(),
        differences: DIFFERENCES.to_vec(),
    }
}

#[cfg(test)]
mod tests;
