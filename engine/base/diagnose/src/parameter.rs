//! A parameter that a configuration refuses, named by its path.

/// Violation of a rule between parameters that a schema cannot express. The reader of the configuration knows where the
/// parameter is written and turns it into a [`crate::Diagnostic`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParameterError {
    /// Keys from the configuration's table to the offending value, such as `["speed", "min_mps"]`.
    pub path: Vec<String>,
    /// The value and the violated rule, in the words of a diagnostic message.
    pub message: String,
    /// Advice: what to do.
    pub hint: Option<String>,
}
