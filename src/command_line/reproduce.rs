//! `reproduce`: the published tables of the five sources computed anew, and the joint laws of one of them.

mod friction;
mod kavi;
mod page;
mod pirdayr;
mod tian;
mod zhao;

use std::fmt::Write as _;
use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

use bolted_joint::reproduce::{Draws, PublishedTable, Reproduction, Row, UnknownTable, reproduce};

use super::error::CliError;
use super::output::print;
use super::progress::Progress;
use super::table::{Table, number};

/// `reproduce`
#[derive(Debug, Args)]
#[command(after_help = names())]
pub(super) struct ReproduceArguments {
    /// Tables, such as 4.6, or steps of chapter 5, such as m10x16, of Tol's thesis, or `tol` for all of them [default: tol]; or
    /// one of `pirdayr`, `tian`, `kavi` and `zhao`, for what can be computed of these; or 2.2, for Tol's joint laws
    tables: Vec<Source>,
    /// Draws of the noise, for mean and spread [default: 100]
    #[arg(long, value_name = "NUMBER")]
    draws: Option<u32>,
    /// Seed of the draws [default: 1]
    #[arg(long)]
    seed: Option<u64>,
    /// Samples of each harmonic test in response pollution, which the thesis does not give; may be given several times
    /// [default: 4096 and 16777216]
    #[arg(long, value_name = "NUMBER")]
    samples: Vec<u32>,
    /// Print the tables as JSON
    #[arg(long, conflicts_with = "markdown")]
    json: bool,
    /// Print the tables as a document in Markdown
    #[arg(long)]
    markdown: bool,
    /// Also draw damping over what is varied, for `kavi`, or the loops, for 2.2
    #[arg(long, value_name = "NAME.svg")]
    figure: Option<PathBuf>,
}

/// Draws of the noise, and samples of a harmonic test, where none are given.
const DRAWS: u32 = 100;
const SAMPLES: [u32; 2] = [4096, 16_777_216];

impl ReproduceArguments {
    /// Refuses what is for noise.
    fn refuse_draws(&self, expected: &'static str) -> Result<(), CliError> {
        let options = [
            ("--draws", self.draws.is_some()),
            ("--seed", self.seed.is_some()),
            ("--samples", !self.samples.is_empty()),
        ];
        match options.iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(CliError::option(option, "it", expected)),
            None => Ok(()),
        }
    }
}

/// What is computed anew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Source {
    /// A table of Tol's thesis.
    Table(PublishedTable),
    /// All tables of Tol's thesis.
    Tol,
    /// A source whose tables have another form.
    Alone(Alone),
}

/// A source that is computed as a whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Alone {
    /// Chapter 2.2 of Tol's thesis.
    Friction,
    Pirdayr,
    Tian,
    Kavi,
    Zhao,
}

const TOL: &str = "tol";

impl Alone {
    const ALL: [Self; 5] = [
        Self::Friction,
        Self::Pirdayr,
        Self::Tian,
        Self::Kavi,
        Self::Zhao,
    ];

    /// What the command line calls it, and what it shows.
    fn words(self) -> [&'static str; 2] {
        match self {
            Self::Friction => [
                "2.2",
                "Tol, chapter 2.2: joint laws as closed loops; also `tol 2.2`",
            ],
            Self::Pirdayr => [
                "pirdayr",
                "Pirdayr, Tables 3 and 4: frequencies of the updated lap joint",
            ],
            Self::Tian => [
                "tian",
                "Tian, Table I: layers that stand for a joint, and the surfaces that would give them",
            ],
            Self::Kavi => [
                "kavi",
                "Kavi, Table 5.1: riveted beams, printed numbers and statements",
            ],
            Self::Zhao => [
                "zhao",
                "Zhao, Table 3: its errors, and the contact under the pressures that it names",
            ],
        }
    }

    fn has_figure(self) -> bool {
        matches!(self, Self::Friction | Self::Kavi)
    }

    /// Whether this only says whose thesis it is from.
    fn is_named_by(self, other: Source) -> bool {
        other == Source::Alone(self) || (self == Self::Friction && other == Source::Tol)
    }

    fn run(self, arguments: &ReproduceArguments) -> Result<(), CliError> {
        match self {
            Self::Friction => friction::run(arguments),
            Self::Pirdayr => pirdayr::run(arguments),
            Self::Tian => tian::run(arguments),
            Self::Kavi => kavi::run(arguments),
            Self::Zhao => zhao::run(arguments),
        }
    }
}

impl FromStr for Source {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        if text == TOL {
            return Ok(Self::Tol);
        }
        // `tol-2.2` says whose chapter it is in one word
        let chapter = text.strip_prefix("tol-").unwrap_or(text);
        let mut alone = Alone::ALL.into_iter();
        let is_meant = |alone: &Alone| match alone {
            Alone::Friction => alone.words()[0] == chapter,
            _ => alone.words()[0] == text,
        };
        if let Some(alone) = alone.find(is_meant) {
            return Ok(Self::Alone(alone));
        }
        text.parse()
            .map(Self::Table)
            .map_err(|unknown: UnknownTable| {
                let others = Alone::ALL.map(|alone| alone.words()[0]).join(", ");
                format!("{unknown}, or {TOL} for all of these, or one of {others}")
            })
    }
}

pub(super) fn run(arguments: &ReproduceArguments) -> Result<(), CliError> {
    let alone = arguments.tables.iter().find_map(|source| match source {
        Source::Alone(alone) => Some(*alone),
        Source::Table(_) | Source::Tol => None,
    });
    if arguments.figure.is_some() && !alone.is_some_and(Alone::has_figure) {
        return Err(CliError::option(
            "--figure",
            "other tables",
            "`kavi` or `2.2`, which have a figure",
        ));
    }
    if let Some(alone) = alone {
        let mut others = arguments.tables.clone();
        others.retain(|&other| !alone.is_named_by(other));
        if !others.is_empty() {
            return Err(CliError::option(
                alone.words()[0],
                format_args!("{} tables beside it", others.len()),
                "it alone: it has a table of another form",
            ));
        }
        arguments.refuse_draws("none: nothing is drawn but for the tables of Tol's thesis")?;
        return alone.run(arguments);
    }
    let wanted = arguments.tables.iter().filter_map(|source| match source {
        Source::Table(table) => Some(*table),
        Source::Tol | Source::Alone(_) => None,
    });
    let wanted: Vec<PublishedTable> = wanted.collect();
    let all = arguments.tables.contains(&Source::Tol);
    if arguments.draws == Some(0) {
        return Err(CliError::option(
            "--draws",
            "0",
            "at least one draw of the noise",
        ));
    }
    let draws = Draws {
        count: arguments.draws.unwrap_or(DRAWS),
        seed: arguments.seed.unwrap_or(1),
        samples: match arguments.samples.as_slice() {
            [] => SAMPLES.to_vec(),
            given => given.to_vec(),
        },
    };
    let tables = if all || wanted.is_empty() {
        PublishedTable::ALL.to_vec()
    } else {
        wanted
    };
    let cases: usize = tables
        .iter()
        .map(|table| table.noisy_cases(draws.samples.len()))
        .sum();
    if cases == 0 {
        arguments.refuse_draws("none: nothing is drawn for these tables, which have no noise")?;
    }
    let progress = Progress::new("reproducing", cases * draws.count as usize);
    let found = tables
        .iter()
        .map(|&table| reproduce(table, &draws, &|| progress.advance()))
        .collect::<Result<Vec<_>, _>>()?;
    drop(progress);
    if arguments.json {
        return print(&serde_json::to_string_pretty(&found)?);
    }
    if arguments.markdown {
        return print(document(&found, &draws).trim_end());
    }
    let texts: Vec<String> = found.iter().map(text).collect();
    print(&texts.join("\n"))
}

/// What the tables are called, for `--help`.
pub(super) fn names() -> String {
    let mut text = "Tables:\n".to_owned();
    for table in PublishedTable::ALL {
        let names = [&[table.key()], table.aliases()].concat().join(", ");
        let _ = writeln!(text, "  {names:<18}{table}");
    }
    let _ = writeln!(text, "  {TOL:<18}all of these");
    for [name, shows] in Alone::ALL.map(Alone::words) {
        let _ = writeln!(text, "  {name:<18}{shows}");
    }
    text.trim_end().to_owned()
}

/// Columns of every table.
const COLUMNS: [&str; 10] = [
    "",
    "",
    "true",
    "published",
    "error",
    "obtained",
    "± std. dev.",
    "error",
    "median",
    "unit",
];

/// One table for people.
fn text(found: &Reproduction) -> String {
    let mut text = format!("{}\n\n", found.table);
    let mut table = Table::new(&COLUMNS);
    for cells in lines(found) {
        table.row(cells);
    }
    text += &table.render();
    for (heading, lines) in remarks(found) {
        let _ = writeln!(text, "\n{heading}:");
        for line in lines {
            let _ = writeln!(text, "  {line}");
        }
    }
    text
}

/// The cells of each line; a case is named in its first.
fn lines(found: &Reproduction) -> Vec<Vec<String>> {
    let mut last_case = "";
    let mut all = Vec::new();
    for row in &found.rows {
        let shown = if row.case == last_case { "" } else { &row.case };
        all.push(cells(shown, row));
        last_case = &row.case;
    }
    all
}

/// What is said about a table, under headings.
fn remarks(found: &Reproduction) -> impl Iterator<Item = (&'static str, &[String])> {
    let all = [
        ("Computed with", found.conditions.as_slice()),
        ("Not given in the thesis", &found.not_given),
        ("Differences", &found.differences),
    ];
    all.into_iter().filter(|(_, lines)| !lines.is_empty())
}

/// All tables as one document.
fn document(found: &[Reproduction], draws: &Draws) -> String {
    let samples: Vec<String> = draws.samples.iter().map(u32::to_string).collect();
    let mut text = format!(
        "# The published tables, computed anew\n\n\
         Ş. Tol, *Dynamic Modeling of Structural Joints*, MSc thesis, Middle East Technical University, 2012: published values \
         beside those that come out here. Written by\n\n    bolted-joint reproduce --markdown --draws {} --seed {}{}\n\n\
         Obtained values are means over {} draws of the noise, with the standard deviation of one draw, where there is noise; \
         errors are those against the true joint, which is known where the assembly is synthesised.\n\n\
         In short: where the thesis gives all that a table rests on, what is published comes out within two standard deviations of one draw. \
         Rotations by differences and initial estimates come out as published, and neither is the joint: noise and differences \
         hide a singular value. What depends on a length or a place that only a figure shows does not come out to the digit; \
         under each table stands what is not given. [Theory](theory.md#7a-the-published-tables-computed-anew) has the reasons \
         in one place.\n",
        draws.count,
        draws.seed,
        samples
            .iter()
            .map(|number| format!(" --samples {number}"))
            .collect::<String>(),
        draws.count,
    );
    text += "\n## Contents\n\n";
    for found in found {
        let heading = found.table.to_string();
        let _ = writeln!(text, "* [{heading}](#{})", anchor(&heading));
    }
    for found in found {
        let _ = writeln!(text, "\n## {}\n", found.table);
        let _ = writeln!(text, "| {} |", COLUMNS.join(" | "));
        let _ = writeln!(text, "|---|---|{}---|", "---:|".repeat(COLUMNS.len() - 3));
        for cells in lines(found) {
            let _ = writeln!(text, "| {} |", cells.join(" | ").replace("|H|", "\\|H\\|"));
        }
        for (heading, lines) in remarks(found) {
            let _ = writeln!(text, "\n{heading}:\n");
            for line in lines {
                let _ = writeln!(text, "* {line}");
            }
        }
    }
    text
}

/// What a link to a heading ends in, as GitHub makes it.
fn anchor(heading: &str) -> String {
    let heading = heading.to_lowercase().replace(' ', "-");
    heading
        .chars()
        .filter(|character| character.is_alphanumeric() || matches!(character, '-' | '_'))
        .collect()
}

/// Significant digits of a computed number, and most of a given one.
const DIGITS: usize = 4;
const MOST_DIGITS: usize = 8;

fn cells(case: &str, row: &Row) -> Vec<String> {
    let digits = row
        .published
        .or(row.truth)
        .map_or(DIGITS, |value| digits_of(value).max(DIGITS));
    let optional = |value: Option<f64>, digits| {
        value.map_or_else(|| "-".to_owned(), |value| number(value, digits))
    };
    let error = |value: Option<f64>| match (value, row.truth) {
        (Some(value), Some(truth)) if truth != 0.0 => percent(100.0 * (value / truth - 1.0)),
        _ => "-".to_owned(),
    };
    let obtained = row.obtained;
    let noisy = obtained.filter(|spread| spread.draws > 1);
    vec![
        case.to_owned(),
        row.quantity.clone(),
        optional(row.truth, digits),
        optional(row.published, digits),
        error(row.published),
        optional(obtained.map(|spread| spread.mean), digits),
        optional(noisy.map(|spread| spread.standard_deviation), 2),
        error(obtained.map(|spread| spread.mean)),
        optional(noisy.map(|spread| spread.median), digits),
        row.unit.to_owned(),
    ]
}

/// Digits that a given number needs, and no more than it may well have been printed with.
fn digits_of(value: f64) -> usize {
    let is_all = |digits: &usize| number(value, *digits).parse() == Ok(value);
    (1..MOST_DIGITS).find(is_all).unwrap_or(MOST_DIGITS)
}

/// An error in per cent; far-off ones by their size alone.
fn percent(value: f64) -> String {
    if value.abs() < 0.05 {
        "0.0 %".to_owned()
    } else if value.abs() < 1e3 {
        format!("{value:+.1} %")
    } else {
        format!("{value:+.0e} %")
    }
}
