//! The whole figure, read back from its text.

use std::collections::BTreeSet;

use num_complex::Complex64;

use super::{FrfFigure, FrfPanel};

/// An element: its name, its attributes, the text directly inside.
#[derive(Debug, Default)]
struct Node {
    name: String,
    attributes: Vec<(String, String)>,
    text: String,
}

impl Node {
    fn get(&self, name: &str) -> &str {
        let found = self.attributes.iter().find(|(own, _)| own == name);
        found.map_or("", |(_, value)| value)
    }

    fn number(&self, name: &str) -> f64 {
        self.get(name)
            .parse()
            .unwrap_or_else(|_| panic!("{name} of {self:?}"))
    }
}

fn unescaped(text: &str) -> String {
    let mut parts = text.split('&');
    let mut plain = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (entity, rest) = part.split_once(';').expect("an entity ends in a semicolon");
        plain.push(match entity {
            "amp" => '&',
            "lt" => '<',
            "gt" => '>',
            "quot" => '"',
            "#39" => '\'',
            other => panic!("unknown entity {other}"),
        });
        plain.push_str(rest);
    }
    plain
}

/// All elements of a document in order. Panics if it is not well formed: tags that do not match, attributes that are
/// not quoted or given twice, bare `<` or `&`, forbidden characters, several roots.
fn parse(document: &str) -> Vec<Node> {
    let forbidden = |character: char| character < ' ' && character != '\n';
    assert!(!document.contains(forbidden), "control characters");
    let mut nodes: Vec<Node> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    let mut pieces = document.split('<');
    assert_eq!(pieces.next(), Some(""), "text before the root");
    for piece in pieces {
        assert!(
            nodes.is_empty() || !open.is_empty(),
            "a second root: {piece}"
        );
        let (tag, text) = piece.split_once('>').expect("a tag ends");
        assert!(!text.contains('>'), "bare > in {text}");
        if let Some(name) = tag.strip_prefix('/') {
            let node = open.pop().expect("something to close");
            assert_eq!(nodes[node].name, name);
        } else {
            let (tag, empty) = tag
                .strip_suffix('/')
                .map_or((tag, false), |tag| (tag, true));
            let (name, mut rest) = tag.split_once(' ').unwrap_or((tag, ""));
            assert!(
                !name.is_empty() && name.chars().all(char::is_alphanumeric),
                "{name}"
            );
            let mut node = Node {
                name: name.to_owned(),
                ..Node::default()
            };
            while !rest.is_empty() {
                let (name, value) = rest.split_once("=\"").expect("a quoted attribute");
                let (value, after) = value.split_once('"').expect("a closing quote");
                assert!(node.get(name).is_empty(), "{name} twice");
                node.attributes
                    .push((name.trim().to_owned(), unescaped(value)));
                rest = after.trim_start();
            }
            nodes.push(node);
            if !empty {
                open.push(nodes.len() - 1);
            }
        }
        match open.last() {
            Some(&node) => nodes[node].text.push_str(&unescaped(text)),
            None => assert!(text.trim().is_empty(), "text after the root"),
        }
    }
    assert!(open.is_empty(), "not closed: {open:?}");
    nodes
}

/// The corners of a path of relative moves and lines.
fn corners(path: &str) -> Vec<(f64, f64)> {
    let mut at = (0.0, 0.0);
    let mut corners = Vec::new();
    for command in path
        .replace('m', "\nm")
        .replace('l', "\nl")
        .replace('h', "\nh")
        .lines()
    {
        let Some((kind, numbers)) = command.split_at_checked(1) else {
            continue;
        };
        let numbers = numbers.replace('-', " -");
        let numbers: Vec<f64> = numbers
            .split_whitespace()
            .map(|number| number.parse().expect("number"))
            .collect();
        match (kind, &numbers[..]) {
            ("m" | "l", &[dx, dy]) => at = (at.0 + dx, at.1 + dy),
            ("h", &[0.0]) => {}
            other => panic!("unexpected {other:?}"),
        }
        corners.push(at);
    }
    corners
}

/// Receptance of single-degree-of-freedom oscillators of unit mass, added up: (Hz, damping ratio, participation).
fn oscillators(modes: &[(f64, f64, f64)], frequency_hz: &[f64]) -> Vec<Complex64> {
    let turn = std::f64::consts::TAU;
    let receptance = |frequency: f64, &(natural, damping, share): &(f64, f64, f64)| {
        let (omega, omega_0) = (turn * frequency, turn * natural);
        // h = a / (ω₀² − ω² + 2iζω₀ω)
        share
            / Complex64::new(
                omega_0 * omega_0 - omega * omega,
                2.0 * damping * omega_0 * omega,
            )
    };
    let sum = |&frequency: &f64| modes.iter().map(|mode| receptance(frequency, mode)).sum();
    frequency_hz.iter().map(sum).collect()
}

fn lines(count: u32, step: f64) -> Vec<f64> {
    (0..count)
        .map(|line| 5.0 + step * f64::from(line))
        .collect()
}

/// `function` with about ±1 % of repeatable noise.
fn noisy(function: &[Complex64]) -> Vec<Complex64> {
    let mut state = 1_u32;
    let mut noise = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        0.02 * (f64::from(state >> 8) / f64::from(1_u32 << 24) - 0.5)
    };
    function
        .iter()
        .map(|value| value * Complex64::new(1.0 + noise(), noise()))
        .collect()
}

fn panel<'a>(measured: &'a [Complex64], regenerated: &'a [Complex64]) -> FrfPanel<'a> {
    FrfPanel {
        label: "12:+Y / 12:+Y".to_owned(),
        unit: "m/N",
        measured,
        regenerated,
        uncoupled: None,
    }
}

fn figure<'a>(frequency_hz: &'a [f64], panels: Vec<FrfPanel<'a>>) -> FrfFigure<'a> {
    FrfFigure {
        title: "Title",
        subtitle: "Sub-title",
        frequency_hz,
        panels,
    }
}

fn with_colour<'a>(nodes: &'a [Node], name: &str, key: &str, colour: &str) -> Vec<&'a Node> {
    nodes
        .iter()
        .filter(|node| node.name == name && node.get(key) == colour)
        .collect()
}

const BLUE: &str = "#0072b2";

#[test]
fn resonances_are_written_at_the_analytic_frequencies() {
    let frequency_hz = lines(2029, 0.25);
    let functions = [(18.25, 0.01, 1.0), (114.75, 0.02, 1.0), (343.0, 0.03, 1.0)]
        .map(|mode| oscillators(&[mode], &frequency_hz));
    let panels = functions
        .iter()
        .map(|function| panel(&[], function))
        .collect();
    let nodes = parse(&figure(&frequency_hz, panels).to_svg());
    let labels = with_colour(&nodes, "text", "fill", BLUE);
    let labels: Vec<&str> = labels.iter().map(|node| node.text.as_str()).collect();
    // f₀√(1 − 2ζ²): 18.248, 114.704, 342.691
    assert_eq!(labels, ["18.2", "114.7", "342.7"]);
}

#[test]
fn the_highest_line_of_a_sharp_peak_is_on_the_page_where_it_belongs() {
    // 20 000 lines, a hundred to a pixel; the peak is one line wide.
    let frequency_hz = lines(20_000, 0.025);
    let mut regenerated = vec![Complex64::new(1e-6, 0.0); 20_000];
    regenerated[12_345] = Complex64::new(8e-3, 0.0);
    let nodes = parse(&figure(&frequency_hz, vec![panel(&[], &regenerated)]).to_svg());
    let curves = with_colour(&nodes, "path", "stroke", BLUE);
    let solid = curves
        .iter()
        .filter(|node| node.get("stroke-dasharray").is_empty());
    let magnitude = solid
        .clone()
        .map(|node| corners(node.get("d")))
        .find(|path| path.len() > 100);
    let magnitude = magnitude.expect("a curve");
    let frame = nodes
        .iter()
        .find(|node| node.name == "rect" && node.get("fill") == "none");
    let frame = frame.expect("a frame");
    let highest = magnitude
        .iter()
        .copied()
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .expect("a point");
    // The axis goes from 0 to 504.975 Hz and, by 1, 2, 5 outside 1e-6/1.25 and 8e-3 · 1.25, from 5e-7 to 1e-2.
    let x = frame.number("width") * (5.0 + 0.025 * 12_345.0) / 504.975;
    let y = frame.number("height") * (1e-2_f64 / 8e-3).log10() / (1e-2_f64 / 5e-7).log10();
    assert!(
        (highest.0 - x).abs() < 0.01 && (highest.1 - y).abs() < 0.01,
        "{highest:?}"
    );
}

#[test]
fn a_phase_has_no_upright_line_from_edge_to_edge() {
    // A pure delay: the phase turns at a constant rate.
    let frequency_hz = lines(2029, 0.25);
    let delayed: Vec<Complex64> = frequency_hz
        .iter()
        .map(|frequency| Complex64::from_polar(1e-6, -0.05 * frequency))
        .collect();
    let nodes = parse(&figure(&frequency_hz, vec![panel(&[], &delayed)]).to_svg());
    let curves = with_colour(&nodes, "path", "stroke", BLUE);
    let phase = curves
        .iter()
        .map(|node| node.get("d"))
        .max_by_key(|path| path.len())
        .expect("phase");
    // −0.05 f from −0.25 to −25.6 rad passes −π, −3π, −5π and −7π.
    assert_eq!(phase.matches('m').count(), 5);
    for line in phase.split('m').flat_map(|piece| piece.split('l').skip(1)) {
        let (_, dy) = corners(&format!("l{line}"))[0];
        assert!((0.0..10.0).contains(&dy), "{line}");
    }
}

#[test]
fn three_panels_of_two_thousand_noisy_lines_stay_below_300_kilobytes() {
    let frequency_hz = lines(2029, 0.25);
    let regenerated = oscillators(&[(18.25, 0.01, 1.0), (343.0, 0.03, -1.0)], &frequency_hz);
    let measured = noisy(&regenerated);
    let mut one = panel(&measured, &regenerated);
    one.uncoupled = Some(&measured);
    let figure = figure(&frequency_hz, vec![one.clone(), one.clone(), one]);
    let text = figure.to_svg();
    parse(&text);
    assert!(text.len() < 300_000, "{}", text.len());
    assert_eq!(text, figure.clone().to_svg());
}

#[test]
fn odd_data_give_a_page_all_the_same() {
    let nan = Complex64::new(f64::NAN, 0.0);
    let infinite = Complex64::new(0.0, f64::INFINITY);
    let values = |value: f64| vec![Complex64::new(value, 0.0); 3];
    let (zero, equal, huge) = (values(0.0), values(-1e-6), values(1e308));
    let mixed = vec![nan, Complex64::new(1e-6, 1e-6), infinite];
    let frequencies: [&[f64]; 5] = [
        &[],
        &[10.0],
        &[10.0, 10.0, 10.0],
        &[f64::NAN, 1.0, f64::INFINITY],
        &[0.0, 1.0, 2.0],
    ];
    for frequency_hz in frequencies {
        for measured in [&zero, &equal, &huge, &mixed, &Vec::new()] {
            for regenerated in [&zero, &equal, &huge, &mixed, &Vec::new()] {
                let mut odd = panel(measured, regenerated);
                odd.uncoupled = Some(&mixed);
                let text = figure(frequency_hz, vec![odd.clone(), odd]).to_svg();
                parse(&text);
                let written = text.to_lowercase();
                assert!(
                    !written.contains("nan") && !written.contains("inf"),
                    "{text}"
                );
            }
        }
    }
    let text = figure(&[], Vec::new()).to_svg();
    assert!(parse(&text).iter().any(|node| node.text == "no functions"));
}

#[test]
fn a_single_line_is_a_dot() {
    let one = [Complex64::new(1e-6, 0.0)];
    let nodes = parse(&figure(&[100.0], vec![panel(&[], &one)]).to_svg());
    let dots = with_colour(&nodes, "path", "stroke", BLUE);
    assert_eq!(
        dots.iter()
            .filter(|node| node.get("d").ends_with("h0"))
            .count(),
        2
    );
}

#[test]
fn texts_come_back_as_they_were_given() {
    let one = [Complex64::new(1e-6, 0.0)];
    let mut odd = panel(&one, &one);
    odd.label = "<a> & \"b\" / 'c'".to_owned();
    odd.unit = "m/s²/N & <>";
    let mut figure = figure(&[1.0], vec![odd]);
    figure.title = "A & B < C";
    let nodes = parse(&figure.to_svg());
    for expected in [
        "<a> & \"b\" / 'c'",
        "magnitude, m/s²/N & <>",
        "A & B < C",
        "Sub-title",
        "frequency, Hz",
    ] {
        assert!(nodes.iter().any(|node| node.text == expected), "{expected}");
    }
}

#[test]
fn crowded_resonances_are_marked_only_where_there_is_room() {
    let frequency_hz = lines(5000, 0.1);
    let modes: Vec<(f64, f64, f64)> = (1..60)
        .map(|mode| (8.0 * f64::from(mode), 1e-3, 1.0))
        .collect();
    let regenerated = oscillators(&modes, &frequency_hz);
    let panels = vec![panel(&[], &regenerated); 3];
    let nodes = parse(&figure(&frequency_hz, panels).to_svg());
    let mut middles: Vec<f64> = with_colour(&nodes, "text", "fill", BLUE)
        .iter()
        .map(|node| node.number("x"))
        .collect();
    middles.sort_by(f64::total_cmp);
    assert!(
        middles.len() >= 3 * 5 && middles.len() < 3 * 12,
        "{}",
        middles.len()
    );
    // "123.4" is 4 digits and a point: 29 pixels in Helvetica at 11.5.
    assert!(
        middles.windows(2).all(|pair| pair[1] - pair[0] > 25.0),
        "{middles:?}"
    );
}

#[test]
fn rows_share_columns_and_units_share_axes() {
    let frequency_hz = [1.0, 2.0];
    let one = [Complex64::new(1e-6, 0.0), Complex64::new(2e-6, 0.0)];
    let of = |unit| FrfPanel {
        unit,
        ..panel(&one, &one)
    };
    let names = |units: &[&'static str]| {
        let panels = units.iter().map(|&unit| of(unit)).collect();
        let nodes = parse(&figure(&frequency_hz, panels).to_svg());
        let names: Vec<String> = nodes.iter().map(|node| node.text.clone()).collect();
        let count = names
            .iter()
            .filter(|name| name.starts_with("magnitude"))
            .count();
        let widths: BTreeSet<String> = with_colour(&nodes, "rect", "fill", "none")
            .iter()
            .map(|node| node.get("width").to_owned())
            .collect();
        (count, widths.len())
    };
    assert_eq!(names(&["m/N", "m/N", "m/N"]), (1, 1));
    assert_eq!(names(&["m/N", "rad/N", "rad/N"]), (2, 1));
    // Two rows of two; the first panel of a row always has its axis.
    assert_eq!(names(&["m/N", "rad/N", "m/N", "m/N"]), (3, 1));
}
