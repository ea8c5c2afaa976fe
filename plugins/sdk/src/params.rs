//! Parameters: declared once, as a struct with documentation, defaults and ranges.

use crate::Json;

/// A type that parameters can have.
pub trait Param: Sized {
    /// The JSON Schema without the braces, such as `"type":"number"`.
    fn schema() -> String;
    /// Reads a value that fits the schema.
    ///
    /// # Errors
    /// The kind of value that is wanted.
    fn read(value: &Json) -> Result<Self, String>;
    /// As JSON.
    fn show(&self) -> String;
}

/// All parameters of a plugin; made by [`params!`](crate::params).
pub trait Params: Param {}

/// For plugins without parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoParams;

impl Params for NoParams {}

impl Param for NoParams {
    fn schema() -> String {
        r#""type":"object","properties":{},"additionalProperties":false"#.to_owned()
    }
    fn read(_: &Json) -> Result<Self, String> {
        Ok(Self)
    }
    fn show(&self) -> String {
        "{}".to_owned()
    }
}

impl Param for f64 {
    fn schema() -> String {
        r#""type":"number""#.to_owned()
    }
    fn read(value: &Json) -> Result<Self, String> {
        match value {
            Json::Number(number) => Ok(*number),
            _ => Err("a number is wanted".to_owned()),
        }
    }
    fn show(&self) -> String {
        format!("{self:?}")
    }
}

impl Param for u32 {
    fn schema() -> String {
        r#""type":"integer","minimum":0,"maximum":4294967295"#.to_owned()
    }
    fn read(value: &Json) -> Result<Self, String> {
        match value {
            Json::Number(number) if *number >= 0.0 && *number <= 4294967295.0 => Ok(*number as u32),
            _ => Err("a whole number is wanted".to_owned()),
        }
    }
    fn show(&self) -> String {
        self.to_string()
    }
}

impl Param for bool {
    fn schema() -> String {
        r#""type":"boolean""#.to_owned()
    }
    fn read(value: &Json) -> Result<Self, String> {
        match value {
            Json::Bool(value) => Ok(*value),
            _ => Err("true or false is wanted".to_owned()),
        }
    }
    fn show(&self) -> String {
        self.to_string()
    }
}

impl Param for String {
    fn schema() -> String {
        r#""type":"string""#.to_owned()
    }
    fn read(value: &Json) -> Result<Self, String> {
        match value {
            Json::Text(text) => Ok(text.clone()),
            _ => Err("a text is wanted".to_owned()),
        }
    }
    fn show(&self) -> String {
        quoted(self)
    }
}

impl<T: Param> Param for Vec<T> {
    fn schema() -> String {
        format!(r#""type":"array","items":{{{}}}"#, T::schema())
    }
    fn read(value: &Json) -> Result<Self, String> {
        match value {
            Json::List(items) => items.iter().map(T::read).collect(),
            _ => Err("a list is wanted".to_owned()),
        }
    }
    fn show(&self) -> String {
        format!("[{}]", self.iter().map(T::show).collect::<Vec<_>>().join(","))
    }
}

impl<const N: usize> Param for [f64; N] {
    fn schema() -> String {
        format!(r#""type":"array","items":{{"type":"number"}},"minItems":{N},"maxItems":{N}"#)
    }
    fn read(value: &Json) -> Result<Self, String> {
        let numbers = Vec::<f64>::read(value)?;
        numbers.try_into().map_err(|_| format!("{N} numbers are wanted"))
    }
    fn show(&self) -> String {
        self.to_vec().show()
    }
}

/// A text as JSON.
#[doc(hidden)]
pub fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => out.extend(['\\', character]),
            control if control < ' ' => out.push_str(&format!("\\u{:04x}", control as u32)),
            other => out.push(other),
        }
    }
    out.push('"');
    out
}

/// Joins the lines of a documentation comment.
#[doc(hidden)]
pub fn sentence(lines: &[&str]) -> String {
    lines.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ")
}

/// A struct of parameters: `name: type = default, [smallest, largest];` with the range left out where there is none. Types are `f64`,
/// `u32`, `bool`, `String`, `[f64; N]`, structs made by this macro, and lists (`Vec`) of them.
#[macro_export]
macro_rules! params {
    (
        $(#[doc = $about:literal])*
        $visibility:vis struct $name:ident {
            $(
                $(#[doc = $doc:literal])*
                $field:ident : $kind:ty = $default:expr $(, [$low:expr, $high:expr])? ;
            )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug, PartialEq)]
        $visibility struct $name {
            $( $(#[doc = $doc])* pub $field: $kind, )*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $( $field: $default, )* }
            }
        }

        impl $crate::Params for $name {}

        impl $crate::Param for $name {
            fn schema() -> String {
                let mut properties: Vec<String> = Vec::new();
                $({
                    let default: $kind = $default;
                    let mut rule = <$kind as $crate::Param>::schema();
                    rule.push_str(&format!(
                        r#","description":{},"default":{}"#,
                        $crate::__private_quoted(&$crate::__private_sentence(&[$($doc),*])),
                        $crate::Param::show(&default)
                    ));
                    $( rule.push_str(&format!(r#","minimum":{:?},"maximum":{:?}"#, $low, $high)); )?
                    properties.push(format!(r#""{}":{{{}}}"#, stringify!($field), rule));
                })*
                format!(r#""type":"object","properties":{{{}}},"additionalProperties":false"#, properties.join(","))
            }

            fn read(value: &$crate::Json) -> Result<Self, String> {
                Ok(Self {
                    $(
                        $field: match value.get(stringify!($field)) {
                            ::core::option::Option::Some(given) => <$kind as $crate::Param>::read(given)
                                .map_err(|wanted| format!("`{}`: {wanted}", stringify!($field)))?,
                            ::core::option::Option::None => $default,
                        },
                    )*
                })
            }

            fn show(&self) -> String {
                let fields: Vec<String> = vec![
                    $( format!(r#""{}":{}"#, stringify!($field), $crate::Param::show(&self.$field)) ),*
                ];
                format!("{{{}}}", fields.join(","))
            }
        }
    };
}

/// Reads the text that `configure` is given.
#[doc(hidden)]
pub fn from_text<P: Params>(text: &str) -> Result<P, String> {
    P::read(&Json::parse(if text.trim().is_empty() { "{}" } else { text })?)
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::params! {
        /// A place.
        struct Place {
            /// Where.
            at: [f64; 2] = [0.0, 1.0];
        }
    }

    crate::params! {
        /// Some.
        struct Wishes {
            /// How far, metres;
            /// "about".
            far_m: f64 = 2.0, [0.5, 10.0];
            /// Where.
            places: Vec<Place> = vec![Place::default()];
        }
    }

    #[test]
    fn a_schema_is_json_with_defaults_and_ranges_and_values_are_read_back() {
        let schema = Json::parse(&format!("{{{}}}", Wishes::schema())).unwrap();
        let far = schema.get("properties").and_then(|it| it.get("far_m")).unwrap();
        assert_eq!(far.get("default"), Some(&Json::Number(2.0)));
        assert_eq!(far.get("maximum"), Some(&Json::Number(10.0)));
        assert_eq!(far.get("description"), Some(&Json::Text("How far, metres; \"about\".".into())));
        let read: Wishes = from_text(r#"{"places":[{"at":[3,4]}]}"#).unwrap();
        assert_eq!(read, Wishes { far_m: 2.0, places: vec![Place { at: [3.0, 4.0] }] });
        assert_eq!(from_text::<Wishes>(&read.show()).unwrap(), read);
    }
}
