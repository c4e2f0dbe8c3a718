"""The faults that plant.py plants, and the tests that notice them."""
import faults_of_error
import faults_of_meshes
import faults_of_rays
import faults_of_scans

FAULTS = (faults_of_rays.FAULTS + faults_of_error.FAULTS + faults_of_scans.FAULTS
          + faults_of_meshes.FAULTS)
