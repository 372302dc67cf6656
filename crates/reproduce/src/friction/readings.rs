//! Parameters as the thesis says that they are found: the stiffness from the slope of a loop (figure 2.4), those of Valanis' law
//! from its closed hysteresis (figure 2.7).

use serde::Serialize;

use bolted_joint_respond::LoopPoint;

use super::{ChapterLaw, FrictionLoop, LawParameter};

/// A parameter read from a loop.
#[derive(Clone, Debug, Serialize)]
pub struct LoopReading {
    /// Which law.
    pub law: ChapterLaw,
    /// Which of its loops.
    pub case: String,
    /// Which parameter; `k_0 + k_1` is the stiffness of (2.2) while it sticks.
    pub symbol: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What the law was computed with.
    pub taken: f64,
    /// What the loop tells.
    pub read: f64,
}

/// What can be read from the loops of those laws that have a stiffness.
pub(super) fn all(loops: &[FrictionLoop]) -> Vec<LoopReading> {
    loops.iter().flat_map(of_loop).collect()
}

fn of_loop(from: &FrictionLoop) -> Vec<LoopReading> {
    let reading = |symbol, unit, taken, read| LoopReading {
        law: from.law,
        case: from.case.clone(),
        symbol,
        unit,
        taken,
        read,
    };
    let Some(tangents) = Tangents::of(from) else {
        return Vec::new();
    };
    let taken = |symbol: &str| {
        let named = |of: &&LawParameter| of.symbol == symbol;
        from.parameters
            .iter()
            .find(named)
            .map_or(0.0, |of| of.value)
    };
    let Tangents { sticking, slipping } = tangents;
    match from.law {
        ChapterLaw::Signum | ChapterLaw::LuGre => Vec::new(),
        ChapterLaw::ElastoSlip => {
            let stiffness = taken("k_0") + taken("k_1");
            vec![reading("k_0 + k_1", "N/m", stiffness, sticking)]
        }
        ChapterLaw::Iwan => vec![reading("K_T", "N/m", taken("K_T"), sticking)],
        ChapterLaw::Valanis => {
            let force = tangents.force_where_they_meet(from);
            vec![
                reading("E_0", "N/m", taken("E_0"), sticking),
                reading("E_t", "N/m", taken("E_t"), slipping),
                reading("σ_0", "N", taken("σ_0"), force),
            ]
        }
    }
}

/// Slopes of a closed loop at its tip, N/m.
#[derive(Clone, Copy)]
struct Tangents {
    /// Behind the reversal.
    sticking: f64,
    /// Before it.
    slipping: f64,
}

impl Tangents {
    fn of(from: &FrictionLoop) -> Option<Self> {
        let [first, second, .., before, last] = from.points.as_slice() else {
            return None;
        };
        let slope =
            |a: &LoopPoint, b: &LoopPoint| (b.load - a.load) / (b.displacement - a.displacement);
        Some(Self {
            sticking: slope(first, second),
            slipping: slope(before, last),
        })
    }

    /// Half of the way in force from the lower tip, along the tangent there, to the tangent at the upper tip.
    fn force_where_they_meet(self, from: &FrictionLoop) -> f64 {
        // −F + E₀ d = F + E_t (d − 2U); half of the way in force is E₀ d/2, and d → 2σ₀/E₀ where the loop is long
        let free = from.force_at_tip_n - self.slipping * from.amplitude_m;
        self.sticking * free / (self.sticking - self.slipping)
    }
}
