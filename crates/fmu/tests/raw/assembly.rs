//! The start-value file of a small assembly: one elastic mode and a free body, and a joint between them.

/// The first value reference of what it lists.
pub(crate) const FIRST: u32 = 4096;

/// Laws of the joint, by the lines of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Laws {
    /// A cubic spring.
    Cubic,
    /// A slider, and a law with an inner state beside it.
    Friction,
    /// A slider beside springs over the preload, which is an input.
    Preload,
}

impl Laws {
    /// Variables beside those of every such assembly: inner states and remembered numbers, rates, indicators.
    const fn counts(self) -> [usize; 4] {
        match self {
            Self::Cubic => [0, 0, 0, 0],
            Self::Friction => [1, 1, 1, 2],
            Self::Preload => [0, 1, 0, 2],
        }
    }

    /// Number of preloads that are inputs, with an energy each assembly of such joints has.
    const fn preloads(self) -> usize {
        match self {
            Self::Cubic | Self::Friction => 0,
            Self::Preload => 1,
        }
    }

    /// Number of continuous states.
    pub(crate) const fn states(self) -> usize {
        6 + self.counts()[0]
    }

    /// Number of event indicators.
    pub(crate) const fn indicators(self) -> usize {
        self.counts()[3]
    }

    /// The variables in their order: role, name, unit, start.
    fn list(self) -> Vec<String> {
        let preload = ["limited lap.preload N.m 8"];
        let mut list: Vec<String> = ["input push.F N 0"]
            .iter()
            .chain(preload.iter().take(self.preloads()))
            .chain(&["state modal.q1 m 0", "state modal.q2 m 0"])
            .chain(&["state modal.v1 m/s 0", "state modal.v2 m/s 0"])
            .chain(&["state energy.supplied J 0", "state energy.dissipated J 0"])
            .map(|line| (*line).to_owned())
            .collect();
        let [inner, remembered, rates, indicators] = self.counts();
        let mut add = |role: &str, count: usize, name: &str| {
            list.extend((0..count).map(|which| format!("{role} {name}{which} 1 0")));
        };
        add("inner", inner, "joint.inner");
        add("output", 2, "tip.");
        add("output", 1, "joint.F");
        add("output", remembered, "joint.remembered");
        add("output", 3 + self.preloads(), "energy.");
        add("derivative", 2, "modal.a");
        add("derivative", rates, "joint.rate");
        add("indicator", indicators, "joint.indicator");
        list
    }

    /// One more than the largest value reference.
    pub(crate) fn end(self) -> u32 {
        FIRST + self.list().len() as u32
    }

    /// Place of the energy that is stored.
    const fn apart(self) -> usize {
        let [inner, remembered, ..] = self.counts();
        10 + self.preloads() + inner + remembered
    }

    /// Text of `start.txt`.
    pub(crate) fn start_text(self, token: &str) -> String {
        let list = self.list();
        let lines: Vec<String> = list.iter().map(|line| format!("{line}\n")).collect();
        let apart = self.apart();
        let [inner, ..] = self.counts();
        let first = 1 + self.preloads();
        let derivatives = apart + 3 + self.preloads();
        let mut states = vec![
            format!("{first} {} 1e-4", first + 2),
            format!("{} {} 1e-4", first + 1, first + 3),
            format!("{} {} 1e-3", first + 4, apart + 1),
            format!("{} {} 1e-3", first + 5, apart + 2),
            format!("{} {derivatives} 0.1", first + 2),
            format!("{} {} 0.1", first + 3, derivatives + 1),
        ];
        if inner > 0 {
            states.push(format!("{} {} 1e-5", first + 6, derivatives + 2));
        }
        let laws = match self {
            Self::Cubic => vec!["joint.k3_y 1e12"],
            Self::Friction => vec![
                "joint.jenkins_k_y 1e6",
                "joint.jenkins_h_y 20",
                "joint.bouc_wen_k_y 1e6",
                "joint.bouc_wen_h_y 20",
                "joint.bouc_wen_n_y 1.5",
                "joint.bouc_wen_beta_y 0.7",
                "joint.bouc_wen_gamma_y -0.2",
            ],
            Self::Preload => vec!["joint.jenkins_k_y 1e6", "joint.jenkins_h_y 20"],
        };
        let table = match self {
            Self::Cubic | Self::Friction => "",
            Self::Preload => "table 3 refused 8\n4 2e5 40 2e12\n8 4e5 20 1e12\n20 5e5 10 0\n",
        };
        format!(
            "bolted-joint-start/1\nmodel assembly\ntoken {token}\nvariables {}\n{}apart {apart}\nstates {}\n{}\n\
             coordinates 2\n800.0 0.0\ndamping 1\n0 0 32.0\nloads 1\n0.0 1.4142135623730951\nmotions 1\n\
             0.0 1.4142135623730951\njoints 1\njoint lap y\n-1.2 1.4142135623730951\n4e5\n20.0\nlaws {}\n{}\n{table}",
            list.len(),
            lines.concat(),
            states.len(),
            states.join("\n"),
            laws.len(),
            laws.join("\n"),
        )
    }
}
