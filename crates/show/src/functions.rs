//! Measured functions: what was measured between which degrees of freedom, in which units, and how good it is.

use std::collections::BTreeMap;
use std::path::Path;

use bolted_joint_frf::{
    Dof, FileSummary, FrfReading, FrfSet, ReadOptions, StatedBy, UnitStatement, read_frfs,
    receptance_unit, resonances, without_phase,
};
use bolted_joint_report::{DrawnFunction, FunctionGroup, ShownPicture};
use serde_json::{Value, json};

use crate::quality::{drive_points, half_power_lines, reciprocities};
use crate::shown::{counted, short, some};
use crate::{ShowError, Shown};

/// Names, resonances and pairs that are listed at most.
const LISTED: usize = 12;
/// Part of Im H that noise may turn at a drive point.
const ACTIVE: f64 = 0.05;
/// Median difference of transposed functions that noise and sensors explain.
const NOT_RECIPROCAL: f64 = 0.1;
/// Lines that a resonance should have within its half-power bandwidth.
const FEWEST_LINES: usize = 3;
/// γ² below which a line is counted.
const LOW_COHERENCE: f64 = 0.9;
/// Equal distances between lines may differ by what six digits show.
const EQUAL: f64 = 1e-4;

/// Measured functions; or matrices, which come in files of the same formats.
pub(crate) fn or_matrices(path: &Path) -> Result<Shown, ShowError> {
    match read_frfs(path, &ReadOptions::default()) {
        Ok(reading) => shown(reading),
        Err(refused) => crate::matrices::shown(path).map_err(|_| refused.into()),
    }
}

fn shown(reading: FrfReading) -> Result<Shown, ShowError> {
    let summary = reading.summary();
    let formats: Vec<String> = summary.formats.iter().map(ToString::to_string).collect();
    let mut shown = Shown::of(formats.join(", "));
    let skipped = reading.skipped();
    let taken = reading.taken().iter();
    let taken: Vec<String> = taken
        .map(|(what, name)| format!("{what} from {name}"))
        .collect();
    if !taken.is_empty() {
        shown.fact("arrays", taken.join(", "));
    }
    let units_are_stated = reading.units_are_stated();
    if reading.functions().is_empty() && !reading.coherences.is_empty() {
        coherences_alone(&reading, &mut shown);
        shown.facts_of("passed over", skipped);
        return Ok(shown);
    }
    if reading.functions().is_empty() && !skipped.is_empty() {
        return Ok(without_functions(&reading));
    }
    let set = reading.into_set()?;
    between(&set, &mut shown);
    quantity_and_units(&summary, &set, &mut shown);
    lines(&set, &mut shown);
    coherence(&summary, &set, &mut shown);
    found_resonances(&set, &mut shown);
    checks(&set, &mut shown);
    if !units_are_stated {
        shown.warnings.push(
            "no units are stated, so SI is assumed; state them in the study, such as units = { length = \"mm\", force = \"N\" }"
                .to_owned(),
        );
    }
    shown.facts_of("passed over", skipped);
    shown.pictures = pictures(&set);
    Ok(shown)
}

/// A universal file of other measurements, of a mesh, or of remarks alone.
fn without_functions(reading: &FrfReading) -> Shown {
    let mut shown = Shown::of("universal file without frequency response functions");
    let datasets = reading.skipped();
    shown.detail("data_sets", datasets.clone());
    shown.facts_of("data sets", datasets);
    shown.fact(
        "functions",
        "none: export the measurement as data sets 58 of function type 4 (frequency response function)",
    );
    shown
}

/// A file that belongs beside one of functions.
fn coherences_alone(reading: &FrfReading, shown: &mut Shown) {
    let own = &reading.coherences;
    let pairs = own
        .iter()
        .map(|own| format!("{}/{}", own.response, own.reference));
    let pairs = some(pairs, LISTED);
    shown.fact(
        "coherences",
        format!("{}, and no function: {pairs}", own.len()),
    );
    if let [first, last] = [own[0].frequency_hz.first(), own[0].frequency_hz.last()]
        && let (Some(first), Some(last)) = (first, last)
    {
        let lines = counted(own[0].frequency_hz.len(), "line");
        let ends = format!("{} to {} Hz", short(*first, 6), short(*last, 6));
        shown.fact("lines", format!("{lines}, {ends}"));
    }
    let averages = reading.averages();
    shown.fact(
        "averages",
        averages.map_or_else(|| "not stated".to_owned(), |averages| averages.to_string()),
    );
    shown.fact(
        "belongs",
        "beside the functions of a study: coherence = \"…\" beside frf",
    );
    shown.detail("coherences", own.len());
}

fn between(set: &FrfSet, shown: &mut Shown) {
    let mut responses: Vec<Dof> = set.functions().map(|own| own.0).collect();
    let mut references: Vec<Dof> = set.functions().map(|own| own.1).collect();
    for list in [&mut responses, &mut references] {
        list.sort_unstable();
        list.dedup();
    }
    let count = set.functions().len();
    let all = responses.len() * references.len();
    let of = match count == all {
        true => "every pair".to_owned(),
        false => format!("{count} of {all} pairs"),
    };
    shown.fact(
        "functions",
        format!(
            "{count}: {} by {}, {of}",
            counted(responses.len(), "response"),
            counted(references.len(), "reference")
        ),
    );
    shown.fact("responses", some(&responses, LISTED));
    shown.fact("references", some(&references, LISTED));
    let names = |list: &[Dof]| list.iter().map(Dof::to_string).collect::<Vec<_>>();
    shown.detail("functions", count);
    shown.detail("responses", names(&responses));
    shown.detail("references", names(&references));
}

fn said(by: StatedBy) -> &'static str {
    match by {
        StatedBy::File => "as the file says",
        StatedBy::Caller => "as the study says",
    }
}

fn quantity_and_units(summary: &FileSummary, set: &FrfSet, shown: &mut Shown) {
    let quantities = summary.quantities.iter();
    let quantities = quantities.map(|(quantity, by)| format!("{quantity}, {}", said(*by)));
    shown.facts_of("quantity", quantities);
    let mut units: Vec<&str> = set
        .functions()
        .map(|(response, reference, _)| receptance_unit(response, reference))
        .collect();
    units.sort_unstable();
    units.dedup();
    let understood = format!("understood as receptance in {}", units.join(", "));
    let read = summary.units.iter().map(|statement| match statement {
        UnitStatement::Label(label) => format!("\"{label}\" in the file"),
        UnitStatement::Dataset164(system) => format!("data set 164: {system}"),
        UnitStatement::Caller(system) => format!("as the study says: {system}"),
        UnitStatement::Assumed => "not stated, so SI".to_owned(),
    });
    shown.facts_of("units", read.chain([understood]));
    let names = summary.quantities.iter().map(|own| own.0.to_string());
    shown.detail("quantities", names.collect::<Vec<_>>());
    shown.detail("units", units);
}

fn lines(set: &FrfSet, shown: &mut Shown) {
    let hz = set.frequency_hz();
    let (first, last) = (hz[0], hz[hz.len() - 1]);
    let steps: Vec<f64> = hz.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mean = (last - first) / steps.len().max(1) as f64;
    let apart = match steps.as_slice() {
        [] => String::new(),
        steps if steps.iter().all(|step| (step - mean).abs() <= EQUAL * mean) => {
            format!(", {} Hz apart", short(mean, 5))
        }
        steps => {
            let low = steps.iter().copied().fold(f64::INFINITY, f64::min);
            let high = steps.iter().copied().fold(0.0, f64::max);
            format!(", {} to {} Hz apart", short(low, 3), short(high, 3))
        }
    };
    shown.fact(
        "lines",
        format!(
            "{} from {} to {} Hz{apart}",
            hz.len(),
            short(first, 5),
            short(last, 5)
        ),
    );
    shown.detail("lines", hz.len());
    shown.detail("frequency_hz", json!([first, last]));
    let mut by_unit: BTreeMap<&str, [f64; 2]> = BTreeMap::new();
    for (response, reference, values) in set.functions() {
        let range = by_unit
            .entry(receptance_unit(response, reference))
            .or_insert([f64::INFINITY, 0.0]);
        for norm in values
            .iter()
            .map(|value| value.norm())
            .filter(|norm| *norm > 0.0)
        {
            *range = [range[0].min(norm), range[1].max(norm)];
        }
    }
    let ranges = by_unit.iter().map(|(unit, [low, high])| match *high > 0.0 {
        true => format!("{} to {} {unit}", short(*low, 3), short(*high, 3)),
        false => "0 at all lines".to_owned(),
    });
    shown.facts_of("magnitude", ranges);
}

fn coherence(summary: &FileSummary, set: &FrfSet, shown: &mut Shown) {
    let own = |(response, reference, _)| set.coherence(response, reference);
    let mut all: Vec<f64> = set.functions().filter_map(own).flatten().copied().collect();
    let averages = summary.averages.map_or_else(
        || "averages not stated".to_owned(),
        |(averages, by)| format!("{averages} averages, {}", said(by)),
    );
    if all.is_empty() {
        shown.fact("coherence", format!("none; {averages}"));
        return;
    }
    all.sort_by(f64::total_cmp);
    let low = all.partition_point(|&own| own < LOW_COHERENCE) as f64 / all.len() as f64;
    let mut told = vec![format!(
        "of {}: lowest {:.3}, median {:.3}; {:.1} % of the values below {LOW_COHERENCE}; {averages}",
        counted(summary.coherences, "function"),
        all[0],
        all[all.len() / 2],
        100.0 * low,
    )];
    if let Some([least, median, most]) = summary.coherence_noise {
        told.push(format!(
            "so σ/|H| is {:.2} % at the best line, up to {:.2} % at half of the lines, {:.0} % at the worst",
            100.0 * least,
            100.0 * median,
            100.0 * most
        ));
    }
    shown.facts_of("coherence", told);
    shown.detail(
        "coherence",
        json!({ "functions": summary.coherences, "lowest": all[0], "median": all[all.len() / 2] }),
    );
}

/// Resonances of √Σ|H|² over the functions of the commonest unit.
fn found_resonances(set: &FrfSet, shown: &mut Shown) {
    let mut sum = vec![0.0; set.line_count()];
    let unit = set
        .functions()
        .next()
        .map(|own| receptance_unit(own.0, own.1));
    for (response, reference, values) in set.functions() {
        if Some(receptance_unit(response, reference)) == unit {
            let squares = values.iter().map(|value| value.norm_sqr());
            sum.iter_mut()
                .zip(squares)
                .for_each(|(sum, own)| *sum += own);
        }
    }
    let magnitude: Vec<f64> = sum.iter().map(|own| own.sqrt()).collect();
    let values: Vec<_> = magnitude.iter().map(|&own| own.into()).collect();
    let hz = set.frequency_hz();
    let mut all = resonances(hz, &values);
    all.sort_by(|one, other| other.prominence_decades.total_cmp(&one.prominence_decades));
    let more = all.len().saturating_sub(LISTED);
    all.truncate(LISTED);
    all.sort_by(|one, other| one.frequency_hz.total_cmp(&other.frequency_hz));
    if all.is_empty() {
        return;
    }
    let told: Vec<String> = all.iter().map(|own| short(own.frequency_hz, 5)).collect();
    let more = match more {
        0 => String::new(),
        more => format!(" and {more} that stand out less"),
    };
    shown.fact("resonances", format!("{} Hz{more}", told.join(" ")));
    shown.detail(
        "resonances_hz",
        all.iter().map(|own| own.frequency_hz).collect::<Vec<_>>(),
    );
    let sparse: Vec<String> = all
        .iter()
        .filter(|own| half_power_lines(hz, &magnitude, own.frequency_hz) < FEWEST_LINES)
        .map(|own| short(own.frequency_hz, 5))
        .collect();
    if !sparse.is_empty() {
        shown.warnings.push(format!(
            "fewer than {FEWEST_LINES} lines lie within the half-power bandwidth of the resonance at {} Hz: its damping is hardly \
             measured; zoom in, or measure longer",
            sparse.join(", ")
        ));
    }
}

fn checks(set: &FrfSet, shown: &mut Shown) {
    let drive = drive_points(set);
    let has_no_phase = without_phase(set.functions().map(|own| own.2));
    shown.warnings.extend(has_no_phase.map(str::to_owned));
    if drive.is_empty() {
        shown.fact(
            "drive points",
            "none: no response is where and along what a load is",
        );
    }
    let bad = |share: f64| share > ACTIVE;
    let good: Vec<Dof> = drive
        .iter()
        .filter(|own| !bad(own.active_share))
        .map(|own| own.dof)
        .collect();
    if !good.is_empty() {
        let energy = match has_no_phase {
            None => "take energy, as they must",
            Some(_) => "without a phase nothing tells whether they take energy",
        };
        shown.fact("drive points", format!("{}: {energy}", some(&good, LISTED)));
    }
    for own in drive.iter().filter(|own| bad(own.active_share)) {
        let why = match (own.active_share > 0.5, own.turns_backwards) {
            (true, true) => {
                "the phase rises through the resonances, so the file's time factor is e^(−jωt): conjugate the functions"
            }
            (true, false) => "the sign of the response or of the load is turned",
            (false, _) => "the sensor and the load are not in one place, or their delays differ",
        };
        shown.warnings.push(format!(
            "drive point {}: {:.0} % of the imaginary part of the receptance is positive, as if the structure gave energy: {why}",
            own.dof,
            100.0 * own.active_share
        ));
    }
    shown.detail(
        "drive_points",
        drive
            .iter()
            .map(|own| json!({ "dof": own.dof.to_string(), "active_share": own.active_share }))
            .collect::<Vec<Value>>(),
    );
    let pairs = reciprocities(set);
    if pairs.is_empty() {
        shown.fact("reciprocity", "not measured: no pair both ways");
        return;
    }
    let told = pairs.iter().take(LISTED).map(|own| {
        format!(
            "{} / {}: half of the lines within {:.2} %, the worst {:.0} % at {} Hz",
            own.between[0],
            own.between[1],
            100.0 * own.median,
            100.0 * own.worst.0,
            short(own.worst.1, 5)
        )
    });
    let more = pairs.len().saturating_sub(LISTED);
    let more = (more > 0).then(|| format!("and {}", counted(more, "more pair")));
    shown.facts_of("reciprocity", told.chain(more));
    for own in pairs.iter().filter(|own| own.median > NOT_RECIPROCAL) {
        let between = format!("{} and {}", own.between[0], own.between[1]);
        shown.warnings.push(match own.is_opposite {
            true => format!("the functions between {between} have opposite signs: the direction of a sensor or of a load is turned"),
            false => format!(
                "the functions between {between} differ by {:.0} % at half of the lines: sensor and load are not in one place, or a \
                 sensitivity is wrong",
                100.0 * own.median
            ),
        });
    }
    shown.detail(
        "reciprocity",
        pairs
            .iter()
            .map(|own| {
                let between = own.between.map(|dof| dof.to_string());
                json!({ "between": between, "median": own.median, "worst": own.worst.0, "at_hz": own.worst.1 })
            })
            .collect::<Vec<Value>>(),
    );
}

/// The functions of each reference and unit together.
fn pictures(set: &FrfSet) -> Vec<ShownPicture> {
    let mut groups: BTreeMap<(Dof, &str), Vec<DrawnFunction>> = BTreeMap::new();
    for (response, reference, values) in set.functions() {
        groups
            .entry((reference, receptance_unit(response, reference)))
            .or_default()
            .push(DrawnFunction {
                label: response.to_string(),
                values: values.to_vec(),
                coherence: set.coherence(response, reference).map(<[f64]>::to_vec),
            });
    }
    let groups = groups.into_iter().map(|((reference, unit), functions)| {
        ShownPicture::Functions(FunctionGroup {
            title: format!("Load at {reference}"),
            unit,
            frequency_hz: set.frequency_hz().to_vec(),
            functions,
        })
    });
    groups.collect()
}
