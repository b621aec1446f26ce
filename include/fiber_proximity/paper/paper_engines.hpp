#pragma once

namespace fiber {

/// Makes the paper's engines known to make_engine() and engine_names(), for the rest of the
/// process: the ten hierarchies, AL with the threading scheme, DL-k and DS-k for any even k in
/// [6, 200], and with the standard directions DL-k-classic and DS-k-classic for k of 6, 14, 18 and
/// 26. engine_names() lists k-DOPs with the paper's best k for hair, 20.
///
/// Calls after the first change nothing. Safe from several threads.
void register_paper_engines();

}  // namespace fiber
