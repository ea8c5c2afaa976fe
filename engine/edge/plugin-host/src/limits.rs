//! Limits of plugins: memory, time, and on request an exact number of instructions.

/// Limits of a plugin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PluginLimits {
    /// Most memory, MiB.
    pub memory_mib: u32,
    /// Longest call of a function, milliseconds.
    pub call_ms: u32,
    /// Most instructions of one call, counted exactly, so that the same plugin fails at the same place on every machine; 0 does
    /// not count. With it the plugin runs in strict mode: NaNs have the same bits on every processor, too.
    pub fuel: u64,
}

impl Default for PluginLimits {
    fn default() -> Self {
        Self { memory_mib: 64, call_ms: 1000, fuel: 0 }
    }
}

impl PluginLimits {
    /// Whether instructions are counted and NaNs made canonical.
    pub fn is_strict(&self) -> bool {
        self.fuel > 0
    }

    /// Most memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.memory_mib as usize * 1024 * 1024
    }
}
