//! A request: only `GET` and `HEAD` without a body, only what a browser sends.

use std::io::{ErrorKind, Read};
use std::time::{Duration, Instant};

/// Most bytes of a request.
const MOST_BYTES: usize = 8 << 10;
/// Most header lines.
const MOST_HEADERS: usize = 64;
/// Time from the first byte of a request to its last.
const MOST_TIME: Duration = Duration::from_secs(5);
/// Time that a connection may wait for its next request.
const MOST_IDLE: Duration = Duration::from_secs(15);

/// A request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request {
    /// Path, such as `/api/index`; as it came.
    pub path: String,
    /// Text behind `?`; empty without.
    pub query: String,
    /// Whether the body of the answer is left out.
    pub is_head: bool,
    headers: Vec<(String, String)>,
}

/// Reason why there is no request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoRequest {
    /// The connection ended, or waited too long.
    Over,
    /// Something that is refused: status, and why.
    Refused(u16, &'static str),
}

const BAD: NoRequest = NoRequest::Refused(400, "the request is not of HTTP/1.1");

impl Request {
    /// Reads the next request of a connection whose reads time out now and then; `rest` has bytes that came with the last one.
    ///
    /// # Errors
    /// [`NoRequest`].
    pub fn read(stream: &mut impl Read, rest: &mut Vec<u8>, is_stopped: &dyn Fn() -> bool) -> Result<Self, NoRequest> {
        let (waits_since, mut begun) = (Instant::now(), None);
        loop {
            if let Some(end) = rest.windows(4).position(|four| four == b"\r\n\r\n") {
                let head: Vec<u8> = rest.drain(..end + 4).collect();
                return Self::parse(&head[..end]);
            }
            if rest.len() >= MOST_BYTES {
                return Err(NoRequest::Refused(431, "the request is too long"));
            }
            if !rest.is_empty() && begun.get_or_insert_with(Instant::now).elapsed() > MOST_TIME {
                return Err(NoRequest::Refused(408, "the request did not come whole in time"));
            }
            if is_stopped() || rest.is_empty() && waits_since.elapsed() > MOST_IDLE {
                return Err(NoRequest::Over);
            }
            let mut part = [0; 2048];
            match stream.read(&mut part) {
                Ok(0) => return Err(NoRequest::Over),
                Ok(read) => rest.extend_from_slice(&part[..read]),
                Err(error)
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) => {
                }
                Err(_) => return Err(NoRequest::Over),
            }
        }
    }

    fn parse(head: &[u8]) -> Result<Self, NoRequest> {
        let text = std::str::from_utf8(head).map_err(|_| BAD)?;
        let mut lines = text.split("\r\n");
        let parts: Vec<&str> = lines.next().unwrap_or_default().split(' ').collect();
        let [method, target, "HTTP/1.1"] = parts[..] else { return Err(BAD) };
        if !matches!(method, "GET" | "HEAD") {
            return Err(NoRequest::Refused(405, "the viewer is read-only: it answers GET and HEAD"));
        }
        if !target.starts_with('/') || !target.bytes().all(|byte| byte.is_ascii_graphic()) {
            return Err(BAD);
        }
        let headers = lines.map(header).collect::<Option<Vec<_>>>().ok_or(BAD)?;
        if headers.len() > MOST_HEADERS {
            return Err(NoRequest::Refused(431, "the request has too many headers"));
        }
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        let request = Self { path: path.to_owned(), query: query.to_owned(), is_head: method == "HEAD", headers };
        let has_body = request.header("content-length").is_some_and(|length| length != "0")
            || request.header("transfer-encoding").is_some();
        let is_ambiguous = ["host", "origin", "content-length"].iter().any(|name| request.all(name).count() > 1);
        match has_body || is_ambiguous {
            true => Err(NoRequest::Refused(400, "the request has a body, or a header twice")),
            false => Ok(request),
        }
    }

    /// The first header of a name in lower case.
    pub fn header(&self, name: &str) -> Option<&str> {
        self.all(name).next()
    }

    fn all(&self, name: &str) -> impl Iterator<Item = &str> {
        self.headers.iter().filter(move |(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// The cookie of a name.
    pub fn cookie(&self, name: &str) -> Option<&str> {
        let pairs = self.all("cookie").flat_map(|line| line.split(';'));
        pairs.filter_map(|pair| pair.trim().split_once('=')).find(|(known, _)| *known == name).map(|(_, value)| value)
    }

    /// The value of a name in the query.
    pub fn asked(&self, name: &str) -> Option<&str> {
        self.query.split('&').filter_map(|pair| pair.split_once('=')).find(|(known, _)| *known == name).map(|it| it.1)
    }
}

/// Name, in lower case, and value of a header line.
fn header(line: &str) -> Option<(String, String)> {
    let (name, value) = line.split_once(':')?;
    let is_name =
        !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_');
    let is_value = !value.chars().any(|letter| letter.is_control() && letter != '\t');
    (is_name && is_value).then(|| (name.to_ascii_lowercase(), value.trim().to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<Request, NoRequest> {
        Request::read(&mut &bytes[..], &mut vec![], &|| false)
    }

    #[test]
    fn requests_of_browsers_are_read_one_after_the_other() {
        let mut stream =
            &b"GET /a?b=c HTTP/1.1\r\nHost: x\r\nCookie: p=1; q=2\r\n\r\nHEAD / HTTP/1.1\r\nHOST:y\r\n\r\n"[..];
        let mut rest = vec![];
        let first = Request::read(&mut stream, &mut rest, &|| false).expect("a request");
        assert_eq!((&*first.path, &*first.query, first.is_head), ("/a", "b=c", false));
        assert_eq!((first.header("host"), first.cookie("q"), first.asked("b")), (Some("x"), Some("2"), Some("c")));
        let second = Request::read(&mut stream, &mut rest, &|| false).expect("a request");
        assert_eq!((second.header("host"), second.is_head), (Some("y"), true));
        assert_eq!(Request::read(&mut stream, &mut rest, &|| false), Err(NoRequest::Over));
    }

    #[test]
    fn what_is_no_such_request_is_refused() {
        let long = format!("GET /{} HTTP/1.1\r\n", "a".repeat(9000));
        let many = format!("GET / HTTP/1.1\r\n{}\r\n", "a: b\r\n".repeat(100));
        for (status, text) in [
            (400, "GET / HTTP/1.0\r\n\r\n"),
            (400, "GET http://x/ HTTP/1.1\r\n\r\n"),
            (400, "GET /\u{e9} HTTP/1.1\r\n\r\n"),
            (400, "GET  / HTTP/1.1\r\n\r\n"),
            (400, "GET / HTTP/1.1\r\n folded\r\n\r\n"),
            (400, "GET / HTTP/1.1\r\na b: c\r\n\r\n"),
            (400, "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n"),
            (400, "GET / HTTP/1.1\r\nContent-Length: 5\r\n\r\n"),
            (400, "GET / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"),
            (400, "GET / HTTP/1.1\nHost: a\r\n\r\n"),
            (405, "POST / HTTP/1.1\r\n\r\n"),
            (431, &long),
            (431, &many),
        ] {
            assert!(matches!(read(text.as_bytes()), Err(NoRequest::Refused(found, _)) if found == status), "{text:?}");
        }
        assert!(matches!(read(b"GET /\xff HTTP/1.1\r\n\r\n"), Err(NoRequest::Refused(400, _))));
        assert_eq!(read(b"GET / HT"), Err(NoRequest::Over));
    }
}
