//! Errors of configuration parameters, located by their path.

/// Violation of a rule between parameters that a schema cannot express. The reader of the configuration knows the place
/// of the parameter in the file and converts the error into a [`crate::Diagnostic`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParameterError {
    /// Keys from the configuration's table to the offending value, such as `["speed", "min_mps"]`.
    pub path: Vec<String>,
    /// Statement of the value and the violated rule, as in a diagnostic message.
    pub message: String,
    /// Advice on how to correct it.
    pub hint: Option<String>,
}
