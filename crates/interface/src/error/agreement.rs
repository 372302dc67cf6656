//! Where two model descriptions disagree that one library implements.

/// Where a model description disagrees with the other one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AgreementProblem {
    /// A variable has another value reference than in the other file.
    #[error(
        "variable \"{variable}\" has valueReference {reference}, but {other_reference} in {other}; the same name has the same number in every file"
    )]
    ReferenceDiffers {
        /// Variable's name.
        variable: String,
        /// Value reference here.
        reference: u32,
        /// Name of the other file.
        other: String,
        /// Value reference there.
        other_reference: u32,
    },
    /// A value reference names another variable than in the other file.
    #[error(
        "valueReference {reference} is \"{variable}\", but \"{other_variable}\" in {other}; take a number that no file uses"
    )]
    ReferenceReused {
        /// Value reference.
        reference: u32,
        /// Variable's name here.
        variable: String,
        /// Name of the other file.
        other: String,
        /// Variable's name there.
        other_variable: String,
    },
    /// Value references leave gaps, so that they are no index.
    #[error(
        "valueReference {reference} is used by no file though larger ones are; number the variables without gaps"
    )]
    Gap {
        /// Smallest value reference that is missing.
        reference: u32,
    },
    /// A definition shared by both files differs.
    #[error("{what} \"{name}\" is not the same as in {other}; make them equal")]
    DefinitionDiffers {
        /// Kind of definition.
        what: &'static str,
        /// Its name.
        name: String,
        /// Name of the other file.
        other: String,
    },
}
