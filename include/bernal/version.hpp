#pragma once
#include <string>
#include <string_view>

namespace bernal {

/// "0.2.0"
std::string_view version();

/// Of the source that this was built from: the first twelve digits of its commit, with "+changes" behind them
/// where files differed from it; "unknown" where the source says nothing of it.
std::string_view commit();

/// How often packings have changed. The same scene, seed and packings number give the same packing, to the
/// bit, where C library and kind of processor are the same, whatever version and commit are. So work that was
/// begun, and what is to be compared with it, belongs to a packings number.
int packings_number();

/// Which bernal made something.
struct Program {
  std::string version, commit;
  int packings_number = 0;  ///< 0: of an earlier bernal, which did not count
};

/// The one that runs.
Program this_program();

/// "0.2.0 (packings 25, commit 0123456789ab)"; "of unknown version" of none.
std::string text_of(const Program&);

/// Of one with another packings number, for messages: "bernal 0.2.0 (packings 24, commit 0123456789ab), and
/// this is 0.2.1 (packings 25, commit 9876543210fe), which packs otherwise".
std::string beside_this(const Program&);

}  // namespace bernal
