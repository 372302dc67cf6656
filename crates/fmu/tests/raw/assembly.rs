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
}

impl Laws {
    /// Variables beside those of every such assembly: inner states and remembered numbers, rates, indicators.
    const fn counts(self) -> [usize; 4] {
        match self {
            Self::Cubic => [0, 0, 0, 0],
            Self::Friction => [1, 1, 1, 2],
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

    /// The variables in their order: role, name, unit.
    fn list(self) -> Vec<String> {
        let mut list: Vec<String> = ["input push.F N", "state modal.q1 m", "state modal.q2 m"]
            .iter()
            .chain(&["state modal.v1 m/s", "state modal.v2 m/s"])
            .chain(&["state energy.supplied J", "state energy.dissipated J"])
            .map(|line| (*line).to_owned())
            .collect();
        let [inner, remembered, rates, indicators] = self.counts();
        let mut add = |role: &str, count: usize, name: &str| {
            list.extend((0..count).map(|which| format!("{role} {name}{which} 1")));
        };
        add("inner", inner, "joint.inner");
        add("output", 2, "tip.");
        add("output", 1, "joint.F");
        add("output", remembered, "joint.remembered");
        add("output", 3, "energy.");
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
        10 + inner + remembered
    }

    /// Text of `start.txt`.
    pub(crate) fn start_text(self, token: &str) -> String {
        let list = self.list();
        let lines: Vec<String> = list.iter().map(|line| format!("{line} 0\n")).collect();
        let apart = self.apart();
        let [inner, ..] = self.counts();
        let mut states = vec!["1 3 1e-4".to_owned(), "2 4 1e-4".to_owned()];
        states.extend([
            format!("5 {} 1e-3", apart + 1),
            format!("6 {} 1e-3", apart + 2),
        ]);
        states.extend([
            format!("3 {} 0.1", apart + 3),
            format!("4 {} 0.1", apart + 4),
        ]);
        if inner > 0 {
            states.push(format!("7 {} 1e-5", apart + 5));
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
        };
        format!(
            "bolted-joint-start/1\nmodel assembly\ntoken {token}\nvariables {}\n{}apart {apart}\nstates {}\n{}\n\
             coordinates 2\n800.0 0.0\ndamping 1\n0 0 32.0\nloads 1\n0.0 1.4142135623730951\nmotions 1\n\
             0.0 1.4142135623730951\njoints 1\njoint lap y\n-1.2 1.4142135623730951\n4e5\n20.0\nlaws {}\n{}\n",
            list.len(),
            lines.concat(),
            states.len(),
            states.join("\n"),
            laws.len(),
            laws.join("\n"),
        )
    }
}
