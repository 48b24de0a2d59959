//! A page that is served.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::thread;

use super::error::LiveError;
use super::hub::Hub;
use super::request::Access;
use super::server::serve;
use super::token::Token;
use super::watcher::LiveWatcher;
use vibrissa_lab::stream::RunSetup;

/// How a page is served.
#[derive(Debug, Clone, Default)]
pub struct LiveOptions {
    /// Address and port. By default, only this machine is served, at a free port.
    pub address: Option<String>,
    /// A token that the URL has to contain. Another address than that of this machine alone has a random one by default.
    pub token: Option<String>,
    /// Breakpoints: names of states, transitions and conditions.
    pub breakpoints: Vec<String>,
    /// True if runs wait before their first tick.
    pub is_paused: bool,
    /// Ratio of simulated time to wall time. `None` for no limit.
    pub speed: Option<f64>,
}

/// A page that is served. It stays through several runs.
pub struct Live {
    hub: Arc<Hub>,
    url: String,
    is_paused: bool,
    speed: Option<f64>,
}

impl Live {
    /// Begins to serve a page.
    ///
    /// # Errors
    /// [`LiveError`] if the address or the token cannot be used.
    pub fn start(options: LiveOptions) -> Result<Self, LiveError> {
        let LiveOptions { address, token, breakpoints, is_paused, speed } = options;
        let address = match address {
            Some(text) => text.parse().map_err(|_| LiveError::Address(text))?,
            None => SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 0),
        };
        let token = match token {
            Some(text) => Some(Token::given(&text)?),
            None if address.ip().is_loopback() => None,
            None => Some(Token::random()?),
        };
        let hub = Arc::new(Hub::default());
        hub.set_breakpoints(breakpoints, Vec::new());
        let bound = serve(address, |address| Access { address, token: token.clone() }, &hub)?;
        // All addresses of this machine are served, and this one is always among them.
        let shown = if bound.ip().is_unspecified() { (Ipv4Addr::LOCALHOST, bound.port()).into() } else { bound };
        let query = token.map_or_else(String::new, |token| format!("?token={}", token.text()));
        Ok(Self { hub, url: format!("http://{shown}/{query}"), is_paused, speed })
    }

    /// The URL of the page.
    #[must_use]
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Begins a run. `is_over` ends a run that is paused, for instance because a file has changed. The result has messages for the user
    /// about breakpoints that the policy does not have.
    ///
    /// # Errors
    /// [`LiveError`] if the rig does not have what the policy needs.
    pub fn begin<'i>(
        &self,
        setup: RunSetup,
        is_over: impl FnMut() -> bool + 'i,
    ) -> Result<(LiveWatcher<'i>, Vec<String>), LiveError> {
        LiveWatcher::new(&self.hub, setup, (self.speed, self.is_paused), is_over)
    }

    /// Serves the page until the program ends.
    pub fn serve_on(&self) -> ! {
        loop {
            thread::park();
        }
    }
}
