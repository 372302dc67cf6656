//! What can be wrong with a frame, before it is a model description.

/// What is wrong with a frame or the list of value references.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FrameProblem {
    /// A variable or an unknown is not written as one empty element on one line.
    #[error(
        "line {line} is not one whole element; write it as <{tag} name=\"value\" …/> on a line of its own"
    )]
    NotALine {
        /// Line number, from 1.
        line: usize,
        /// XML element.
        tag: &'static str,
    },
    /// An element has no name.
    #[error("line {line} has no name; name the variable that it is about")]
    NoName {
        /// Line number, from 1.
        line: usize,
    },
    /// An attribute of the frame's own has a word that it cannot have.
    #[error("line {line}: found {attribute}=\"{found}\", expected {expected}")]
    Word {
        /// Line number, from 1.
        line: usize,
        /// Attribute's name.
        attribute: &'static str,
        /// Word found.
        found: String,
        /// Words that it can have.
        expected: &'static str,
    },
    /// A placeholder stands for nothing there.
    #[error(
        "line {line}: {{{placeholder}}} stands for nothing there; is the line one for each DOF?"
    )]
    Placeholder {
        /// Line number, from 1.
        line: usize,
        /// Word between the braces.
        placeholder: String,
    },
    /// A name that is referred to is not declared.
    #[error("line {line} refers to \"{name}\", which no variable has as its name")]
    UndefinedName {
        /// Line number, from 1.
        line: usize,
        /// Name found.
        name: String,
    },
    /// An unknown says nothing of its dependencies, and no line before it does.
    #[error(
        "line {line} says nothing of what \"{name}\" depends on; say it here, or with the same name in a line above"
    )]
    NoDependencies {
        /// Line number, from 1.
        line: usize,
        /// Variable's name.
        name: String,
    },
    /// The frame's type is not what the law says.
    #[error(
        "type \"{declared_type}\" has unit \"{unit}\", but \"{of_law}\" by the declaration of its law; make them agree"
    )]
    TypeUnit {
        /// Type's name.
        declared_type: String,
        /// Its unit in the frame.
        unit: String,
        /// Its unit by the law.
        of_law: String,
    },
    /// The list of value references has a name twice.
    #[error("\"{name}\" has two value references; keep the first")]
    ReferenceTwice {
        /// Variable's name.
        name: String,
    },
}
