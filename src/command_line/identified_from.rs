//! What an identification rests on beside the measured functions, for people: bands, modes, bolts.

use std::fmt::Write as _;

use bolted_joint::identify::{BandOrigin, Bolts, Identification, JointEstimate};

use super::table::number;

/// Which joint the bolts have, as part of a sentence.
pub(super) fn at_bolts(bolts: &Bolts) -> String {
    match bolts {
        Bolts::One => String::new(),
        Bolts::Alike(names) => format!(", the same at {},", listed(names)),
        Bolts::Different(names) => format!(", one each at {},", listed(names)),
    }
}

/// What follows in a message what holds at one torque.
pub(super) fn place(joint: &JointEstimate) -> String {
    joint
        .torque_n_m
        .map(|torque| format!(" at {torque} N·m"))
        .unwrap_or_default()
}

/// What the averages of the table of one torque were taken over; `bolts` are the names of those with a joint of their own.
pub(super) fn averaged(joint: &JointEstimate, bolts: &[String]) -> String {
    if joint.band_averages.is_none() {
        return String::new();
    }
    let mut text = format!("\nband averages{} over\n", place(joint));
    for (bolt, used) in joint.bands.iter().enumerate() {
        for used in used {
            let bolt = bolts.get(bolt).map(|bolt| format!("{bolt} "));
            let ranges = used.bands.iter();
            let ranges =
                ranges.map(|[from, to]| format!("{} to {}", number(*from, 4), number(*to, 4)));
            let ranges = ranges.collect::<Vec<_>>().join(", ");
            let what = match used.origin {
                BandOrigin::Given => format!("{ranges} Hz, as in the study"),
                BandOrigin::Automatic => {
                    format!("{ranges} Hz, chosen by sensitivity and distance to resonances")
                }
                BandOrigin::NoneQualifies => {
                    "all lines, their median: no band qualifies".to_owned()
                }
                BandOrigin::Median => "all lines, their median, as in the study".to_owned(),
            };
            let _ = writeln!(text, "  {}{}: {what}", bolt.unwrap_or_default(), used.name);
        }
    }
    text
}

/// What modes supplied beside measured functions.
pub(super) fn from_modes(found: &Identification) -> String {
    let mut text = String::new();
    for found in &found.from_modes {
        let pairs = found.functions.iter();
        let pairs: Vec<String> = pairs.map(|(p, q)| format!("{p} / {q}")).collect();
        let functions = match pairs.as_slice() {
            [] => "nothing, all functions were measured".to_owned(),
            pairs => format!("{}, taken as exact", pairs.join(", ")),
        };
        let deviation = found.deviation.map(|deviation| {
            format!(
                "; of the measured functions the modes are {:.2} % away (r.m.s.)",
                100.0 * deviation
            )
        });
        let _ = writeln!(
            text,
            "\nfrom the modes of {}: {functions}{}",
            found.substructure,
            deviation.unwrap_or_default()
        );
    }
    text
}

fn listed(names: &[String]) -> String {
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}
