#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

Error::~Error() = default;
InputError::~InputError() = default;

}  // namespace ductile::meshadapt
