//! Text of an assembly file (TOML), beside files of structures and joints that are intact: refused with a reason, or an assembly
//! whose equations are finite, and that moves or is told not to.
#![no_main]

use std::path::PathBuf;
use std::sync::OnceLock;

use bolted_joint_assembly::AssemblyModel;
use bolted_joint_dynamics::Beyond;
use bolted_joint_dynamics::assembly::{AssemblySteps, TOLERANCE};
use bolted_joint_study::StudyText;
use libfuzzer_sys::fuzz_target;

static FOLDER: OnceLock<PathBuf> = OnceLock::new();
/// More coordinates take too long to prepare for.
const MOST: usize = 24;

const CUBIC: &str = r#"{"format": "bolted-joint/1", "name": "cubic", "joint": {"dofs": ["y"], "stiffness": [[5e5]], "damping": [[10]],
    "cubic": [1e15]}}"#;
const SLIDING: &str = r#"{"format": "bolted-joint/1", "name": "sliding", "joint": {"dofs": ["y", "theta"], "stiffness": [[5e5, 0], [0, 1e3]],
    "damping": [[10, 0], [0, 0.1]], "friction": [{"dof": "y", "law": "jenkins", "stiffness": 1e6, "slip_force": 20}]}}"#;
const LOOSENING: &str = r#"{"format": "bolted-joint/1", "name": "loosening", "joint": {"dofs": ["y"], "over_preload": {"preload": [4, 8],
    "nominal": 8, "stiffness": [[[2e5]], [[4e5]]], "damping": [[[20]], [[10]]]}}}"#;

fn prepare() {
    FOLDER.get_or_init(|| {
        let folder = std::env::temp_dir().join(format!("bolted-joint-fuzz-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("the folder can be made");
        for (name, text) in [
            ("cubic", CUBIC),
            ("sliding", SLIDING),
            ("loosening", LOOSENING),
        ] {
            std::fs::write(folder.join(format!("{name}.joint.json")), text)
                .expect("the file can be written");
        }
        folder
    });
}

fuzz_target!(init: prepare(), |text: &str| {
    let Some(folder) = FOLDER.get() else { return };
    let study = StudyText::new(text.to_owned(), &folder.join("assembly.toml"));
    let Ok(model) = AssemblyModel::of(&study) else {
        return;
    };
    if model.size() > MOST {
        return;
    }
    let Ok(assembly) = model.equations_over_preload(Beyond::Refused) else {
        return;
    };
    let _ = model.receptances(&[10.0, 1000.0]);
    let Some(mut steps) = AssemblySteps::new(&assembly, 1e-4, TOLERANCE) else {
        return;
    };
    let mut state = steps.at_rest();
    let mut inputs = vec![1.0; assembly.loads.columns()];
    inputs.extend(assembly.over_preload().map(|law| law.range_n_m()[0]));
    let held = vec![0.0; inputs.len()];
    for _ in 0..3 {
        steps.step(&mut state, &inputs, &held);
    }
    let _ = assembly.stored_energy(
        bolted_joint_dynamics::assembly::AssemblyMotion {
            coordinates: &state.motion[..assembly.size()],
            rates: &state.motion[assembly.size()..],
            laws: &assembly.laws_at(&inputs[assembly.loads.columns()..]),
        },
        &state.memory,
    );
});
