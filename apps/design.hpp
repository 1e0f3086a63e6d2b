#pragma once
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include "command_line.hpp"

#include "bernal/predict/predict.hpp"
#include "bernal/sizes/size_distribution.hpp"
#include "populations.hpp"

// bernal design: one file for each of its commands, and what they share.
Command maximise_command();
Command target_command();
Command best_command();
Command layer_command();

/// A length or an amount in the fewest digits, at most ten, that are right to 1e-10.
std::string number(double value);
/// Refuses diameters that the scene of the answer could not hold: below 1e-20 or above 1e20, so that medians
/// of wide sizes, far below the mean, still fit.
void require_usable_lengths(double smallest, double largest);
/// A share of the volume to a millionth.
double rounded_share(double share);

/// The inline table of populations with these shares, as [spheres] of a scene takes it after "diameter = ".
/// Populations without share are left out, those of one diameter put together.
std::string mixture_table(const std::vector<Population>& populations, const std::vector<double>& shares);

/// The radii that such a table stands for, read as in a scene, so that the answer is about what the user
/// pastes.
std::unique_ptr<bernal::SizeDistribution> sizes_of_table(const std::string& table);

void print_error(const bernal::Prediction& prediction);
/// The lines that end every answer: the error, and the table to paste.
void print_error_and_table(const bernal::Prediction& prediction, const std::string& table);
/// phi, error, rods, and the table alone and as a line of a scene.
nlohmann::ordered_json table_as_json(const bernal::Prediction& prediction, const std::string& table);
