//! What an importer keeps for an instance: resources on disk, the log, and the answers of its callbacks.

use std::{
    ffi::{CStr, CString, c_char, c_int, c_void},
    fs,
    path::Path,
    sync::OnceLock,
};

use bolted_joint_importer::header::{OK, WARNING};

use crate::raw::{
    Fmi3, Raw, SPACE,
    assembly::{FIRST, Laws},
    start_text,
};

/// Token of all FMUs here.
pub(crate) const TOKEN: &CStr = c"{random calls}";

/// One of the FMUs on which the calls are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Model {
    pub(crate) lap: bool,
    pub(crate) dofs: u8,
    cubic_n_per_m3: f64,
    quintic_n_per_m5: f64,
    friction: &'static [Friction],
    is_over_preload: bool,
    /// Whether friction is in the table, and not among the parameters.
    is_friction_in_table: bool,
    /// Of an assembly, which has none of the above.
    pub(crate) assembly: Option<Laws>,
}

/// A law that remembers the motion: its name, and the symbols of its parameters with values.
type Friction = (&'static str, &'static [(&'static str, f64)]);

const IWAN: Friction = (
    "iwan",
    &[
        ("iwan_h", 100.0),
        ("iwan_k", 2e6),
        ("iwan_chi", -0.3),
        ("iwan_beta", 0.5),
    ],
);

const JENKINS: Friction = ("jenkins", &[("jenkins_k", 1e6), ("jenkins_h", 20.0)]);

const LUGRE: Friction = (
    "lugre",
    &[
        ("lugre_s0", 1e6),
        ("lugre_s1", 10.0),
        ("lugre_s2", 6.0),
        ("lugre_fc", 10.0),
        ("lugre_fs", 15.0),
        ("lugre_vs", 1e-3),
    ],
);

const BOUC_WEN: Friction = (
    "bouc-wen",
    &[
        ("bouc_wen_k", 1e6),
        ("bouc_wen_h", 20.0),
        ("bouc_wen_n", 1.5),
        ("bouc_wen_beta", 0.7),
        ("bouc_wen_gamma", -0.2),
    ],
);

/// Laws whose inner state the importer integrates in Model Exchange; the others have to be told where they turn.
const WITH_INNER_STATE: [Friction; 2] = [LUGRE, BOUC_WEN];

const ALL_FRICTION: [Friction; 6] = [
    JENKINS,
    IWAN,
    (
        "valanis",
        &[
            ("valanis_e0", 1e6),
            ("valanis_et", 1e5),
            ("valanis_s0", 20.0),
            ("valanis_kappa", 0.7),
        ],
    ),
    ("dahl", &[("dahl_k", 1e6), ("dahl_h", 10.0)]),
    LUGRE,
    BOUC_WEN,
];

/// Element and lap; one and two degrees of freedom; linear, hardening, softening, with terms of higher order, with
/// friction, and over the preload; and assemblies.
pub(crate) const MODELS: [Model; 28] = [
    Model::new(true, 1, 0.0),
    Model::new(true, 2, 0.0),
    Model::new(true, 1, -2e12),
    Model::new(true, 2, 5e11),
    Model::new(false, 1, 5e11),
    Model::new(false, 2, 0.0),
    Model::with_quintic(true, 2, -2e12, 2e17),
    Model::with_quintic(false, 1, 5e11, -3e17),
    Model::new(false, 1, 0.0).slipping(&[IWAN]),
    Model::new(true, 1, 5e11).slipping(&[IWAN]),
    Model::new(true, 2, 0.0).slipping(&ALL_FRICTION),
    Model::new(false, 1, 0.0).loosening(),
    Model::new(true, 2, 0.0).loosening(),
    Model::new(false, 2, 0.0).slipping(&[JENKINS]).loosening(),
    Model::new(true, 1, 0.0).slipping(&[JENKINS]).loosening(),
    Model::new(false, 1, 0.0).slipping(&ALL_FRICTION).by_table(),
    Model::new(true, 2, 0.0)
        .slipping(&[JENKINS, IWAN])
        .by_table(),
    Model::new(false, 6, 0.0).slipping(&[IWAN]).by_table(),
    Model::new(false, 6, 1e12),
    Model::new(true, 6, -2e12),
    Model::new(false, 6, 0.0).slipping(&ALL_FRICTION),
    Model::new(true, 6, 0.0).slipping(&[IWAN]),
    Model::new(false, 6, 0.0).slipping(&[JENKINS]).loosening(),
    Model::new(false, 1, 0.0).slipping(&WITH_INNER_STATE),
    Model::new(true, 2, 0.0).slipping(&WITH_INNER_STATE),
    Model::assembly(Laws::Cubic),
    Model::assembly(Laws::Friction),
    Model::assembly(Laws::Preload),
];

impl Model {
    const fn new(lap: bool, dofs: u8, cubic_n_per_m3: f64) -> Self {
        Self::with_quintic(lap, dofs, cubic_n_per_m3, 0.0)
    }

    const fn with_quintic(lap: bool, dofs: u8, cubic_n_per_m3: f64, quintic_n_per_m5: f64) -> Self {
        Self {
            lap,
            dofs,
            cubic_n_per_m3,
            quintic_n_per_m5,
            friction: &[],
            is_over_preload: false,
            is_friction_in_table: false,
            assembly: None,
        }
    }

    const fn assembly(laws: Laws) -> Self {
        Self {
            assembly: Some(laws),
            ..Self::new(true, 1, 0.0)
        }
    }

    const fn loosening(self) -> Self {
        Self {
            is_over_preload: true,
            ..self
        }
    }

    const fn by_table(self) -> Self {
        Self {
            is_friction_in_table: true,
            ..self.loosening()
        }
    }

    const fn slipping(self, friction: &'static [Friction]) -> Self {
        Self { friction, ..self }
    }

    /// Number of continuous states.
    pub(crate) fn states(self) -> usize {
        if let Some(laws) = self.assembly {
            return laws.states();
        }
        // motion, and what is counted: heat of a joint that remembers, and work besides of one over the preload
        let counted = match (self.is_over_preload, self.friction) {
            (true, _) => 2,
            (false, []) => 0,
            (false, _) => 1,
        };
        let dofs = usize::from(self.dofs);
        let of_bodies = if self.lap { 4 * dofs + counted } else { 0 };
        let names = self.friction.iter().map(|(name, _)| name);
        of_bodies + dofs * names.filter(|name| has_inner_state(name)).count()
    }

    /// Number of event indicators.
    pub(crate) fn indicators(self) -> usize {
        if let Some(laws) = self.assembly {
            return laws.indicators();
        }
        let mut names = self.friction.iter().map(|(name, _)| name);
        let turns = names.any(|name| !has_inner_state(name));
        if turns { 2 * usize::from(self.dofs) } else { 0 }
    }

    /// Value references of the inputs.
    pub(crate) fn inputs(self) -> &'static [u32] {
        match (self.lap, self.dofs) {
            _ if self.assembly.is_some() => &[FIRST],
            (true, 1) => &[9, 11],
            (true, 6) => &[138, 139, 140, 141, 142, 143, 144, 145, 146, 147, 148, 149],
            (false, 6) => &[
                1, 5, 116, 117, 118, 119, 120, 121, 122, 123, 124, 125, 126, 127, 128, 129, 130,
                131, 132, 133, 134, 135, 136, 137,
            ],
            (true, _) => &[9, 10, 11, 12],
            (false, 1) => &[1, 3, 5, 7],
            (false, _) => &[1, 2, 3, 4, 5, 6, 7, 8],
        }
    }

    /// Value references of the outputs that are no states.
    pub(crate) fn outputs(self) -> &'static [u32] {
        match (self.lap, self.dofs) {
            // the first that are outputs of every such assembly, energies and powers among them
            _ if self.assembly == Some(Laws::Cubic) => &[
                FIRST + 7,
                FIRST + 8,
                FIRST + 9,
                FIRST + 10,
                FIRST + 11,
                FIRST + 12,
            ],
            _ if self.assembly == Some(Laws::Preload) => &[
                FIRST + 8,
                FIRST + 9,
                FIRST + 10,
                FIRST + 12,
                FIRST + 13,
                FIRST + 15,
            ],
            _ if self.assembly.is_some() => &[
                FIRST + 8,
                FIRST + 9,
                FIRST + 10,
                FIRST + 11,
                FIRST + 12,
                FIRST + 14,
            ],
            (true, 1) => &[13, 15, 16],
            (true, 6) => &[15, 16, 150, 151, 152, 153, 154, 155],
            (false, 6) => &[
                15, 16, 138, 139, 140, 141, 142, 143, 144, 145, 146, 147, 148, 149, 150, 151, 152,
                153, 154, 155,
            ],
            (true, _) => &[13, 14, 15, 16],
            (false, 1) => &[9, 11, 13, 15, 16],
            (false, _) => &[9, 10, 11, 12, 13, 14, 15, 16],
        }
    }

    /// The text of `resources/start.txt`.
    pub(crate) fn start_text(self) -> String {
        if let Some(laws) = self.assembly {
            return laws.start_text(&TOKEN.to_string_lossy());
        }
        let changes = [
            ("joint.k3_y", self.cubic_n_per_m3),
            ("joint.k5_y", self.quintic_n_per_m5),
            ("joint.c2_y", self.quintic_n_per_m5.abs() * 1e-11),
        ];
        let mut text = start_text(self.lap, self.dofs, &TOKEN.to_string_lossy(), &changes);
        if self.is_over_preload {
            text = self.over_preload(&text);
        }
        if self.friction.is_empty() {
            return text;
        }
        let names: Vec<&str> = self.friction.iter().map(|(name, _)| *name).collect();
        let first = text.find("token ").expect("the token");
        let first = first + text[first..].find('\n').expect("its line") + 1;
        text.insert_str(first, &format!("laws {}\n", names.join(" ")));
        if self.is_friction_in_table {
            return text;
        }
        for (symbol, value) in self.friction.iter().flat_map(|(_, parameters)| *parameters) {
            let dofs: &[&str] = match self.dofs {
                1 => &["y"],
                2 => &["y", "theta"],
                _ => &SPACE,
            };
            for dof in dofs {
                text += &format!("joint.{symbol}_{dof} {value}\n");
            }
        }
        text
    }

    /// The text with a table in place of the joint's parameters.
    fn over_preload(self, text: &str) -> String {
        let is_joint = |line: &&str| line.starts_with("joint.");
        let lines: Vec<&str> = text.lines().filter(|line| !is_joint(line)).collect();
        let nominal = match (self.friction, self.is_friction_in_table) {
            ([], _) => "",
            (_, false) => " 10",
            (_, true) => " friction",
        };
        let row = |preload: f64| {
            let share = preload / 10.0;
            let (k, c) = (4e6 * share, 8.0 * share);
            match self.dofs {
                1 => format!("{preload} {k} {c} 1e12"),
                6 => {
                    let diagonal = |own: f64| {
                        let entry = |i: usize, j: usize| if i == j { own } else { 0.0 };
                        let upper = (0..6).flat_map(|i| (i..6).map(move |j| (i, j)));
                        upper
                            .map(|(i, j)| entry(i, j).to_string())
                            .collect::<Vec<_>>()
                            .join(" ")
                    };
                    format!("{preload} {} {} 1e12 0 0 0 0 0", diagonal(k), diagonal(c))
                }
                _ => format!("{preload} {k} 1e4 2e3 {c} 0.1 0.25 1e12 0"),
            }
        };
        let row = |preload: f64| {
            let mut row = row(preload);
            if self.is_friction_in_table {
                for _ in 0..self.dofs {
                    row += &friction_at(self.friction, preload / 10.0);
                }
            }
            row
        };
        let table = [5.0, 10.0, 20.0].map(row).join("\n");
        let (head, tail) = lines.split_at(4);
        format!(
            "{}\ntable 3 refused{nominal}\n{table}\n{}\npreload 10\n",
            head.join("\n"),
            tail.join("\n")
        )
        .replace("\n\n", "\n")
    }

    /// Value references that are tried.
    pub(crate) fn references(self) -> Vec<u32> {
        if let Some(laws) = self.assembly {
            return std::iter::once(0).chain(FIRST..laws.end()).collect();
        }
        let end = if self.friction.is_empty() && !self.is_over_preload {
            match self.dofs {
                6 => 702,
                _ => 45,
            }
        } else {
            702
        };
        (0..end).collect()
    }
}

/// Parameters of laws in a line of the table, at this share of the nominal preload: what slips in proportion, springs with its
/// square root, but for the one law whose spring has to stay.
fn friction_at(laws: &[Friction], share: f64) -> String {
    const SLIPS: [&str; 7] = [
        "iwan_h",
        "jenkins_h",
        "valanis_s0",
        "dahl_h",
        "lugre_fc",
        "lugre_fs",
        "bouc_wen_h",
    ];
    const SPRINGS: [&str; 6] = [
        "iwan_k",
        "jenkins_k",
        "valanis_e0",
        "valanis_et",
        "dahl_k",
        "lugre_s0",
    ];
    let all = laws.iter().flat_map(|(_, parameters)| *parameters);
    let at = |&(symbol, value): &(&str, f64)| match symbol {
        symbol if SLIPS.contains(&symbol) => value * share,
        symbol if SPRINGS.contains(&symbol) => value * share.sqrt(),
        _ => value,
    };
    all.map(|parameter| format!(" {}", at(parameter))).collect()
}

fn has_inner_state(law: &str) -> bool {
    WITH_INNER_STATE.iter().any(|(name, _)| *name == law)
}

static RESOURCES: OnceLock<Vec<CString>> = OnceLock::new();

/// Writes the resources of all models below `folder`, once in a process.
pub(crate) fn write_resources(folder: &Path) {
    RESOURCES.get_or_init(|| {
        MODELS
            .iter()
            .enumerate()
            .map(|(index, model)| {
                let path = folder.join(format!("model {index}/resources"));
                fs::create_dir_all(&path).expect("the folder can be made");
                fs::write(path.join("start.txt"), model.start_text()).expect("writable");
                CString::new(path.to_str().expect("UTF-8")).expect("no zero byte")
            })
            .collect()
    });
}

/// Resource folder of the model with this index.
pub(crate) fn resources(model: usize) -> &'static CStr {
    &RESOURCES.get().expect("write_resources comes first")[model]
}

/// What the callbacks of one instance see and answer. Its address is the instance environment.
#[derive(Default)]
pub(crate) struct Host {
    /// Status and text of each message since the last look.
    pub(crate) messages: Vec<(c_int, String)>,
    /// What is wrong with what the library handed to a callback.
    pub(crate) faults: Vec<String>,
    /// Counts calls of the intermediate update; decides about early return.
    pub(crate) updates: u64,
    /// The instance, for callbacks that call back, once it is there.
    pub(crate) instance: Option<*mut c_void>,
    /// Value references that a callback sets and reads.
    pub(crate) references: (&'static [u32], &'static [u32]),
}

impl Host {
    /// Notes a message; `text` and `category` come from the library.
    ///
    /// # Safety
    ///
    /// Both are null or terminated strings.
    pub(crate) unsafe fn note(
        &mut self,
        status: c_int,
        category: *const c_char,
        text: *const c_char,
    ) {
        let mut read = |pointer: *const c_char, what: &str| {
            if pointer.is_null() {
                self.faults.push(format!("{what} is null"));
                return String::new();
            }
            // SAFETY: not null, and terminated by the library's promise
            let bytes = unsafe { CStr::from_ptr(pointer) };
            bytes.to_str().map(str::to_owned).unwrap_or_else(|_| {
                self.faults.push(format!("{what} is not UTF-8"));
                String::new()
            })
        };
        let category = read(category, "category");
        let text = read(text, "message");
        let expected = match status {
            OK => category.starts_with("log"),
            WARNING => category == "logStatusWarning",
            _ => category == "logStatusError",
        };
        if !expected {
            self.faults
                .push(format!("status {status} in category {category}: {text}"));
        }
        self.messages.push((status, text));
    }

    /// Answers an intermediate update: sometimes with the wish to return at once.
    pub(crate) fn wants_early_return(&mut self) -> bool {
        self.updates += 1;
        self.updates % 7 == 3
    }
}

/// `fmi3LogMessageCallback`.
pub(crate) unsafe extern "C" fn log_fmi3(
    environment: *mut c_void,
    status: c_int,
    category: *const c_char,
    text: *const c_char,
) {
    // SAFETY: the environment is the host of the instance, which outlives it
    unsafe { (*environment.cast::<Host>()).note(status, category, text) };
}

/// `fmi2CallbackLogger`; the library never hands over further arguments.
pub(crate) unsafe extern "C" fn log_fmi2(
    environment: *mut c_void,
    _name: *const c_char,
    status: c_int,
    category: *const c_char,
    text: *const c_char,
    _: *const c_char,
) {
    // SAFETY: as above
    unsafe { (*environment.cast::<Host>()).note(status, category, text) };
}

/// `fmi3IntermediateUpdateCallback`.
pub(crate) unsafe extern "C" fn update_fmi3(
    environment: *mut c_void,
    time: f64,
    set_requested: u8,
    get_allowed: u8,
    step_finished: u8,
    can_return_early: u8,
    early_return_requested: *mut u8,
    early_return_time: *mut f64,
) {
    let host = environment.cast::<Host>();
    let flags = [set_requested, get_allowed, step_finished, can_return_early];
    // SAFETY: the environment is the host of the instance; the two last arguments point to one value each
    unsafe {
        if !time.is_finite() || flags.iter().any(|&flag| flag > 1) {
            let fault = format!("intermediate update at {time} s, {flags:?}");
            (*host).faults.push(fault);
        }
        if set_requested == 1 {
            set_input(host, time);
        }
        if get_allowed == 1 {
            get_outputs(host);
        }
        let early = can_return_early == 1 && (*host).wants_early_return();
        early_return_requested.write(early.into());
        if early {
            early_return_time.write(time);
        }
    }
}

/// The instance that has called back, if it is known.
///
/// # Safety
///
/// `host` is that of a living instance. Nothing else may refer to it: the library may call the log callback.
unsafe fn instance(host: *mut Host) -> Option<Raw> {
    // SAFETY: the caller's promise
    let handle = unsafe { (*host).instance }?;
    let version = Fmi3;
    Some(Raw { version, handle })
}

/// Sets an input from within an intermediate update, which the library has asked for.
///
/// # Safety
///
/// As for [`instance`].
unsafe fn set_input(host: *mut Host, time: f64) {
    // SAFETY: the caller's promise
    unsafe {
        let (inputs, _) = (*host).references;
        let (Some(instance), Some(&input)) = (instance(host), inputs.first()) else {
            return;
        };
        if instance.set(&[input], &[time.sin()]) != OK {
            let fault = format!("input {input} cannot be set within a step");
            (*host).faults.push(fault);
        }
    }
}

/// Reads the outputs from within an intermediate update, which the library has allowed.
///
/// # Safety
///
/// As for [`instance`].
unsafe fn get_outputs(host: *mut Host) {
    // SAFETY: the caller's promise
    unsafe {
        let (_, outputs) = (*host).references;
        let Some(instance) = instance(host) else {
            return;
        };
        let messages = (*host).messages.len();
        let values = instance.try_get(outputs).unwrap_or_default();
        // a number that overflows is refused, and that message is not one of the step
        (*host).messages.truncate(messages);
        if !values.iter().all(|value| value.is_finite()) {
            let fault = format!("outputs {values:?} within a step");
            (*host).faults.push(fault);
        }
    }
}
