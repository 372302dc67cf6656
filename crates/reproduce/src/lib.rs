//! The case studies of Tol's thesis, the tables of Pirdayr's, Tian's and Zhao's papers and the specimens of Kavi's thesis computed anew:
//! published and obtained values side by side. The joint laws of Tol's chapter 2.2 are drawn anew.
#![forbid(unsafe_code)]

mod approaches;
mod beams;
mod bolted;
mod draws;
mod error;
mod friction;
mod friction_figure;
mod kavi;
mod kavi_figure;
mod lumped;
mod outcome;
mod pirdayr;
mod published;
mod receptances;
mod texts;
mod tian;
mod zhao;

pub use draws::Draws;
pub use error::ReproduceError;
pub use friction::{
    ChapterFigure, ChapterLaw, FrictionLoop, FrictionReproduction, LawParameter, LoopReading,
    friction,
};
pub use friction_figure::FrictionFigure;
pub use kavi::{
    AMPLITUDE_M, AtBoundary, BOUNDARIES, Claim, KaviReproduction, PrintedNumber, SpecimenMaterial,
    SpecimenRow, Verdict, kavi,
};
pub use kavi_figure::KaviFigure;
pub use outcome::{Reproduction, Row, Spread};
pub use pirdayr::{PirdayrRow, RATIO_OF_TABLE_2, pirdayr};
pub use published::{PublishedTable, UnknownTable};
pub use tian::{TianFit, TianLayer, TianReproduction, tian};
pub use zhao::{
    Denominator, ZhaoContact, ZhaoError, ZhaoFrequency, ZhaoLoss, ZhaoReproduction, zhao,
};

use bolted::Bolts;
use draws::Repetition;

/// Computes a published table anew. `progress` is called after each draw of the noise, of which there are `draws.count` for each of
/// [`PublishedTable::noisy_cases`].
///
/// # Errors
/// [`ReproduceError`] if the numbers of `draws` make no sense.
pub fn reproduce(
    table: PublishedTable,
    draws: &Draws,
    progress: &(dyn Fn() + Sync),
) -> Result<Reproduction, ReproduceError> {
    let repetition = Repetition { draws, progress };
    let rows = match table {
        PublishedTable::Table4_2 => lumped::table_4_2(repetition),
        PublishedTable::Table4_3 => Ok(beams::table_4_3()),
        PublishedTable::Table4_4 => beams::table_4_4(repetition),
        PublishedTable::Table4_5 => beams::table_4_5(repetition),
        PublishedTable::Figures4_30And4_32 => approaches::figures_4_30_and_4_32(),
        PublishedTable::Table4_6 => approaches::table_4_6(repetition),
        PublishedTable::Table4_7 => approaches::table_4_7(repetition),
        PublishedTable::Table4_8 => approaches::table_4_8(repetition),
        PublishedTable::Table4_9 => approaches::table_4_9(repetition),
        PublishedTable::Table5_2 => bolted::table_5_2(repetition),
        PublishedTable::M10x16 => Bolts::published()?.m10x16.chain(repetition),
        PublishedTable::M8x16 => Bolts::published()?.m8x16.chain(repetition),
        PublishedTable::M10x35 => Bolts::published()?.m10x35.chain(repetition),
        PublishedTable::M8x35 => Bolts::published()?.m8x35.chain(repetition),
        PublishedTable::LongM8x35 => bolted::long_m8x35(repetition),
        PublishedTable::Torques => bolted::torques(repetition),
        PublishedTable::M6x30 => Bolts::published()?.m6x30.chain(repetition),
        PublishedTable::TwoM6x30 => bolted::two_m6x30(),
        PublishedTable::Table5_10 => bolted::table_5_10(repetition),
        PublishedTable::Table5_11 => bolted::table_5_11(repetition),
        PublishedTable::Table5_12 => bolted::table_5_12(repetition),
        PublishedTable::Rotation => bolted::with_section(),
    }?;
    texts::with_texts(table, rows, draws)
}
