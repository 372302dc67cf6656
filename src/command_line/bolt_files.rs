//! Names of several joint files of one study: `x.joint.json` stands for `x.left.joint.json`, `x.right.joint.json`.

use std::path::{Path, PathBuf};

use bolted_joint::identify::Bolts;

const EXTENSION: &str = ".joint.json";

/// The joint file of each bolt that has a joint of its own; without such bolts the one file itself.
pub(super) fn of_bolts(path: &Path, bolts: &Bolts) -> Vec<PathBuf> {
    match bolts.with_own_joint() {
        [] => vec![path.to_owned()],
        names => names.iter().map(|name| named(path, name)).collect(),
    }
}

/// The joint file of a bolt, or of a torque.
pub(super) fn named(path: &Path, name: &str) -> PathBuf {
    let file_name = path.file_name().unwrap_or_default().to_string_lossy();
    let extension = match file_name.strip_suffix(EXTENSION) {
        Some(stem) if !stem.is_empty() => EXTENSION,
        _ => "",
    };
    let stem = file_name.strip_suffix(extension).unwrap_or(&file_name);
    path.with_file_name(format!("{stem}.{name}{extension}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_goes_before_the_extension() {
        for (path, expected) in [
            ("out/x.joint.json", "out/x.left.joint.json"),
            ("x.y.joint.json", "x.y.left.joint.json"),
            ("x.json", "x.json.left"),
            (".joint.json", ".joint.json.left"),
        ] {
            assert_eq!(named(Path::new(path), "left"), Path::new(expected));
        }
        let path = Path::new("x.joint.json");
        let alike = Bolts::Alike(vec!["left".to_owned(), "right".to_owned()]);
        assert_eq!(of_bolts(path, &alike), [path]);
    }
}
