// bernal._core, the extension below the package. Scenes come as TOML and answers go as JSON, so the library
// makes all checks, messages and names. Spheres, surfaces and meshes are arrays.
#include <system_error>

#include "bernal/core/error.hpp"
#include "bernal/core/monitor.hpp"
#include "bernal/core/text.hpp"
#include "bernal/engine/engine_error.hpp"
#include "bernal/version.hpp"
#include "python/bindings.hpp"
#include "python/job.hpp"
#include "python/lock.hpp"

namespace py = pybind11;

namespace bernal::python {
namespace {

std::string_view name_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::bad_scene:
      return "bad_scene";
    case ErrorCode::bad_mesh:
      return "bad_mesh";
    case ErrorCode::bad_packing:
      return "bad_packing";
    case ErrorCode::bad_argument:
      return "bad_argument";
    case ErrorCode::cannot_write:
      return "cannot_write";
  }
  return "";
}

/// A function of the package that makes an exception of code, message without the place, file, line and
/// column.
py::object& exception_of_error() {
  static auto* const made = new py::object;  // outlives the interpreter
  return *made;
}

void raise(const Error& error, std::string_view code) {
  const Location& where = error.location();
  std::string message = error.what();
  if (const std::string place = where.text(); !place.empty()) message.erase(0, place.size() + 2);
  message = in_words_of_python(message);
  const py::object raised =
      called(exception_of_error(), py::make_tuple(code, message, where.file, where.line, where.column));
  PyErr_SetObject(py::type::of(raised).ptr(), raised.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const EngineError& error) {
    raise(error, "no_engine");
  } catch (const Error& error) {
    raise(error, name_of(error.code()));
  } catch (const Cancelled&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
  } catch (const Ending& ending) {  // SystemExit ends other threads silently
    if (is_ending_elsewhere()) return PyErr_SetNone(PyExc_SystemExit);
    PyErr_SetString(PyExc_RuntimeError, ending.what());
  } catch (const std::system_error& error) {
    PyErr_SetString(PyExc_OSError, error.what());
  }
}

}  // namespace

std::string in_words_of_python(std::string_view message) {
  return with_options(message, [](std::string_view name, std::string_view value) -> std::string {
    const std::string word(name), said(value);
    if (value.empty()) return word;
    if (value.find_first_not_of("0123456789.,") != value.npos) return word + "='" + said + "'";
    return word + (value.find(',') == value.npos ? "=" + said : "=[" + said + "]");
  });
}

}  // namespace bernal::python

PYBIND11_MODULE(_core, module) {
  using namespace bernal::python;
  py::register_exception_translator(&translate);
  module.attr("version") = bernal::version();
  module.attr("commit") = bernal::commit();
  module.attr("packings_number") = bernal::packings_number();
  module.def("raise_errors_as", [](const py::object& make) { exception_of_error() = make; });
  bind_scene(module);
  bind_packing(module);
  bind_work(module);
  bind_design(module);
}
