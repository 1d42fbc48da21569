#include "adapt_job.hpp"
