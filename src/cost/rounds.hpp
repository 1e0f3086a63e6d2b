#pragma once
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cost/trial.hpp"

namespace bernal::cost {

/// A scene that is one of several to be compared, under a name that tells it from the others.
struct Setting {
  std::string name;
  Scene scene;
  std::shared_ptr<const Domain> meant = {};  ///< see `TrialOptions::meant`
};

/// The trials that were made, in a file that grows by a line with each of them, so that nothing measured is
/// lost. A trial is known by the text of its scene, its seed, the number of threads and the packings number.
///
/// Beside the trials it names the files that were written from them, each with its digest, so that a later
/// call tells these from files of somebody else.
class TrialRecord {
 public:
  /// In memory only.
  TrialRecord() = default;
  /// Reads what the file holds, if there is one; a last line that was not written to its end is left out.
  /// `afresh`: the trials are forgotten, the names of files are not. Throws Error{bad_argument} where the
  /// file is none of these, Error{cannot_write} where nothing can be added to it.
  explicit TrialRecord(std::filesystem::path file, bool afresh = false);
  /// The same, and nothing is written or made yet: what a call would find.
  static TrialRecord read(const std::filesystem::path& file, bool afresh = false);

  /// Null where there is none.
  const Trial* find(const Setting&, std::uint64_t seed, int threads) const;
  /// One that was cut off gives way to one that was not, or was later.
  void add(const Setting&, const Trial&);
  std::size_t size() const { return trials_.size(); }
  /// Trials of bernals with other packings that are not made anew yet; none of them is found.
  std::size_t outdated() const { return outdated_.size(); }
  /// The packings number of one of them. Precondition: there are some.
  int packings_of_outdated() const { return outdated_.begin()->second.packings_number; }

  /// Files in the folder of the record.
  void add_file(const std::string& name, const std::string& sha256);
  bool names_file(const std::string& name, const std::string& sha256) const {
    return written_.contains({name, sha256});
  }

 private:
  std::size_t read_whole(const std::string& whole, bool afresh);  ///< bytes of whole lines
  void append(const std::string& text) const;

  std::filesystem::path file_;
  std::map<std::string, Trial> trials_, outdated_;
  std::set<std::pair<std::string, std::string>> written_;  ///< names and digests
};

struct RoundOptions {
  std::vector<std::uint64_t> seeds = {1, 2};
  int threads = 0;
  /// Seconds on the wall for all that has still to be measured; what runs when they are over ends and is
  /// forgotten.
  double budget = std::numeric_limits<double>::infinity();
  double limit = std::numeric_limits<double>::infinity();  ///< of one trial
  /// One that was cut off sooner had no fair try: it is forgotten, and so nothing is known of its setting.
  double fair = 0;
  bool pass_over_refused = false;  ///< a scene that cannot be run is told of in its series, not thrown
  /// Hears how far all of them have come: the fraction is that of trials, or of the budget if that is more.
  Monitor monitor = {};
};

/// The trials of a setting, in the order of the seeds; those that were not made are missing.
struct Series {
  const Setting* setting = nullptr;
  std::vector<Trial> trials = {};
  std::string refused = {};  ///< why it cannot be run
  bool unfair = false;       ///< a run was cut off before `RoundOptions::fair`
};
struct Rounds {
  std::vector<Series> series;  ///< in the order of the settings
  std::size_t made = 0;        ///< trials that were not in the record before
  bool out_of_time = false, cancelled = false;
};

/// As many as the machine has for 0.
int threads_of(int threads);

/// Runs every setting once with the first seed, then with the second, and so on. Within a round the order is
/// shuffled, and every second round goes through the order of the one before backwards, so that a machine
/// that becomes slower or faster meanwhile does not favour one setting. What the record holds is not run
/// again. Precondition: the settings outlive the result. Throws as `build` for the first scene that cannot
/// be, unless these are passed over; what was measured before is in the record.
Rounds interleaved(const std::vector<Setting>& settings, TrialRecord& record, const RoundOptions& options);

/// The middle one, or the mean of the two in the middle, and half of what lies between the least and the
/// greatest. Precondition: there are some.
struct Spread {
  double median = 0, half_width = 0;
};
Spread spread_of(std::vector<double> values);

/// 64-bit FNV-1a of a text; 16 hexadecimal digits.
std::string hash_of_text(std::string_view text);

}  // namespace bernal::cost
