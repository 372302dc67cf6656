//! The pictures in an FMU: icon, flanges and diagram, each as a drawing and as an image of it.

use super::archive::File;
use super::{FmiVersion, Interface};
use bolted_joint_joint::DofSet;

/// A drawing and its image.
struct Picture {
    svg: &'static str,
    png: &'static [u8],
}

macro_rules! picture {
    ($name:literal) => {
        Picture {
            svg: include_str!(concat!("assets/", $name, ".svg")),
            png: include_bytes!(concat!("assets/", $name, ".png")),
        }
    };
}

const FLANGE_A: Picture = picture!("flange_a");
const FLANGE_B: Picture = picture!("flange_b");

fn icon(interface: Interface) -> Picture {
    match interface {
        Interface::Element => picture!("icon-element"),
        Interface::Lap => picture!("icon-lap"),
    }
}

fn diagram(interface: Interface, dofs: DofSet) -> Picture {
    // those of two stand for more
    match (interface, dofs.count()) {
        (Interface::Element, 1) => picture!("diagram-element-1"),
        (Interface::Element, _) => picture!("diagram-element-2"),
        (Interface::Lap, 1) => picture!("diagram-lap-1"),
        (Interface::Lap, _) => picture!("diagram-lap-2"),
    }
}

/// The diagram for use within a page.
pub(super) fn inline_diagram(interface: Interface, dofs: DofSet) -> String {
    diagram(interface, dofs)
        .svg
        .replace(" xmlns=\"http://www.w3.org/2000/svg\"", "")
}

/// All pictures, at the places where the standard wants them.
pub(super) fn pictures(version: FmiVersion, interface: Interface, dofs: DofSet) -> Vec<File> {
    let icon = icon(interface);
    let mut files = Vec::new();
    if version == FmiVersion::V2 {
        files.push(File::bytes("model.png", icon.png));
    }
    for (path, picture) in [
        ("terminalsAndIcons/icon", icon),
        ("terminalsAndIcons/flange_a", FLANGE_A),
        ("terminalsAndIcons/flange_b", FLANGE_B),
        ("documentation/diagram", diagram(interface, dofs)),
    ] {
        files.push(File::bytes(&format!("{path}.png"), picture.png));
        files.push(File::text(&format!("{path}.svg"), picture.svg));
    }
    files
}
