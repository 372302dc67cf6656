//! The folder of an FMU's resources, with a start-value file in it.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::atomic::{AtomicU32, Ordering},
};

use super::TOKEN;

/// Which FMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Element,
    Lap,
}

/// Parameters of the FMUs with round values, so that expected results can be worked out by hand.
const JOINT: [(&str, f64); 16] = [
    ("joint.k_yy", 4.0e6),
    ("joint.k_ytheta", 1.0e4),
    ("joint.k_thetatheta", 2.0e3),
    ("joint.c_yy", 8.0),
    ("joint.c_ytheta", 0.5),
    ("joint.c_thetatheta", 0.25),
    ("joint.k3_y", 0.0),
    ("joint.k3_theta", 0.0),
    ("joint.k5_y", 0.0),
    ("joint.k5_theta", 0.0),
    ("joint.k7_y", 0.0),
    ("joint.k7_theta", 0.0),
    ("joint.c2_y", 0.0),
    ("joint.c2_theta", 0.0),
    ("joint.c4_y", 0.0),
    ("joint.c4_theta", 0.0),
];

const BODY: [(&str, f64); 6] = [
    ("m", 2.0),
    ("J", 1e-3),
    ("k_y", 8.0e5),
    ("k_theta", 1.0e3),
    ("c_y", 1.0),
    ("c_theta", 1e-3),
];

/// Text of `start.txt` with some parameters replaced.
pub(crate) fn start_text(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> String {
    let mut parameters: Vec<(String, f64)> = JOINT
        .iter()
        .map(|&(name, value)| (name.to_owned(), value))
        .collect();
    if kind == Kind::Lap {
        for side in ["a", "b"] {
            parameters.extend(
                BODY.iter()
                    .map(|(name, value)| (format!("{side}.{name}"), *value)),
            );
        }
        parameters.push(("step_size_max".to_owned(), 2e-5));
    }
    if dofs == 1 {
        parameters.retain(|(name, _)| !name.ends_with("theta") && !name.ends_with(".J"));
    }
    let model = if kind == Kind::Lap { "lap" } else { "element" };
    let mut text = format!("bolted-joint-start/1\nmodel {model}\ndofs {dofs}\ntoken {TOKEN}\n");
    for (name, value) in parameters {
        let value = changes
            .iter()
            .find(|(changed, _)| *changed == name)
            .map_or(value, |(_, v)| *v);
        text += &format!("{name} {value}\n");
    }
    text
}

/// A folder that is removed when the test ends.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!(
            "bolted joint {} {number} {name}",
            std::process::id()
        ));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Folder with a start-value file.
    pub(crate) fn with_start(text: &str) -> Self {
        let folder = Self::new("Prüfung 100% #1");
        fs::write(folder.0.join("start.txt"), text).unwrap();
        folder
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The path as text.
pub(crate) fn text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}
