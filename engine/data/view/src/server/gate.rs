//! Admission: a browser of this machine that came with the token of the session once, and pages of the viewer itself.

use super::request::Request;
use super::response::Response;
use std::hash::{BuildHasher, RandomState};
use std::sync::atomic::{AtomicBool, Ordering};

/// Decides on requests.
pub struct Gate {
    port: u16,
    token: String,
    session: String,
    is_used: AtomicBool,
}

/// Where a request comes from.
pub enum Caller {
    /// A page of this session.
    Known,
    /// The browser that was given the token: it gets this cookie.
    New(String),
}

impl Gate {
    /// A gate with fresh secrets.
    pub fn new(port: u16) -> Self {
        Self { port, token: secret(), session: secret(), is_used: AtomicBool::new(false) }
    }

    /// The address that opens the page, once.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.port, self.token)
    }

    /// Lets a request through, or refuses it. `Host` keeps names of others that lead here out (DNS rebinding), `Origin` and
    /// `Sec-Fetch-Site` pages of others.
    ///
    /// # Errors
    /// The refusal.
    pub fn check(&self, request: &Request) -> Result<Caller, Response> {
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", self.port));
        let host = request.header("host").unwrap_or_default();
        if !hosts.iter().any(|known| known == host) {
            return Err(Response::refusal(421, "the viewer answers to 127.0.0.1 and localhost alone"));
        }
        let is_own = |origin: &str| origin == format!("http://{host}");
        if !request.header("origin").is_none_or(is_own) {
            return Err(Response::refusal(403, "the viewer does not answer pages of others"));
        }
        let is_page = request.path == "/";
        let site = request.header("sec-fetch-site").unwrap_or("same-origin");
        if !is_page && site != "same-origin" {
            return Err(Response::refusal(403, "the viewer does not answer pages of others"));
        }
        if request.cookie(&self.cookie()).is_some_and(|session| is_same(session, &self.session)) {
            return Ok(Caller::Known);
        }
        let has_token = is_page && request.asked("token").is_some_and(|token| is_same(token, &self.token));
        if has_token && !self.is_used.swap(true, Ordering::SeqCst) {
            return Ok(Caller::New(format!("{}={}", self.cookie(), self.session)));
        }
        let words = "this page opens once, in one browser, with the address that `cosfly view` printed; start it again for another one";
        Err(Response::refusal(403, words))
    }

    /// Name of the cookie: ports share cookies.
    fn cookie(&self) -> String {
        format!("cosfly_view_{}", self.port)
    }
}

/// Compares without telling by its time how much is right.
fn is_same(given: &str, secret: &str) -> bool {
    let differences = given.bytes().zip(secret.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
    given.len() == secret.len() && differences == 0
}

/// 256 bits in hex digits that nobody can guess: hashes under keys that the system draws (SipHash, keys of 128 bits). No output
/// depends on them.
fn secret() -> String {
    (0..4).map(|part: u64| format!("{:016x}", RandomState::new().hash_one(part))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(path: &str, headers: &[(&str, &str)]) -> Request {
        let headers: String = headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
        let text = format!("GET {path} HTTP/1.1\r\n{headers}\r\n");
        Request::read(&mut text.as_bytes(), &mut vec![], &|| false).expect("a request")
    }

    #[test]
    fn the_token_opens_once_and_the_cookie_from_then_on() {
        let gate = Gate::new(8123);
        let host = ("Host", "127.0.0.1:8123");
        let path = format!("/?token={}", gate.token);
        assert!(gate.check(&request("/", &[host])).is_err());
        assert!(gate.check(&request(&format!("/api/index?token={}", gate.token), &[host])).is_err());
        let Ok(Caller::New(cookie)) = gate.check(&request(&path, &[host])) else { panic!("the token opens") };
        assert!(gate.check(&request(&path, &[host])).is_err(), "once");
        assert!(matches!(gate.check(&request("/api/index", &[host, ("Cookie", &cookie)])), Ok(Caller::Known)));
        assert!(gate.check(&request("/api/index", &[host, ("Cookie", &format!("{cookie}0"))])).is_err());
        assert_ne!(secret(), secret());
    }

    #[test]
    fn other_names_and_other_pages_are_refused_even_with_the_cookie() {
        let gate = Gate::new(8123);
        let cookie = format!("{}={}", gate.cookie(), gate.session);
        let cookie = ("Cookie", cookie.as_str());
        let host = ("Host", "localhost:8123");
        assert!(gate.check(&request("/api/index", &[host, cookie, ("Origin", "http://localhost:8123")])).is_ok());
        for others in [
            &[("Host", "evil.example:8123"), cookie][..],
            &[("Host", "127.0.0.1"), cookie],
            &[cookie],
            &[host, cookie, ("Origin", "http://evil.example")],
            &[host, cookie, ("Origin", "null")],
            &[host, cookie, ("Sec-Fetch-Site", "cross-site")],
            &[host, cookie, ("Sec-Fetch-Site", "same-site")],
        ] {
            assert!(gate.check(&request("/api/index", others)).is_err(), "{others:?}");
        }
    }
}
